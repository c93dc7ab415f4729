"""Results as ROS 2 messages, with the conventions of `stereo_image_proc` and `depth_image_proc`."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.metric.scene import Scene
from softdepth.metric.writers import millimetres
from softdepth.rig.geometry import Geometry
from softdepth.ros.bag import TYPES

DISPARITY = "stereo_msgs/msg/DisparityImage"
IMAGE = "sensor_msgs/msg/Image"
CLOUD = "sensor_msgs/msg/PointCloud2"

FLOAT32 = 7
"""`sensor_msgs/PointField.FLOAT32`."""


@dataclass(frozen=True)
class Search:
    """What a core can find: its candidates and its steps, in pixels of disparity."""

    least: float
    most: float
    step: float


def image(header: Any, encoding: str, pixels: np.ndarray) -> Any:
    """A `sensor_msgs/Image`, little-endian, without padding."""
    rows = np.ascontiguousarray(pixels, pixels.dtype.newbyteorder("<"))
    height, width = rows.shape[:2]
    step = rows.nbytes // height
    return TYPES.types[IMAGE](
        header=header,
        height=height,
        width=width,
        encoding=encoding,
        is_bigendian=0,
        step=step,
        data=rows.view(np.uint8).ravel(),
    )


def disparity_image(
    header: Any, geometry: Geometry, search: Search, disparity: NDArray[np.floating], valid: NDArray[np.bool_]
) -> Any:
    """A `stereo_msgs/DisparityImage`.

    Disparities are adjusted for the principal points, so that ``Z = f T / d`` without an offset, and what
    is not valid lies a pixel below ``min_disparity``. ``valid_window`` leaves out the columns at the left
    that the farthest candidate cannot serve.
    """
    least, most = search.least + geometry.doffs, search.most + geometry.doffs
    adjusted = np.where(valid, disparity + geometry.doffs, least - 1).astype(np.float32)
    height, width = adjusted.shape
    blind = min(max(int(np.ceil(search.most)), 0), width)
    window = TYPES.types["sensor_msgs/msg/RegionOfInterest"](
        x_offset=blind, y_offset=0, height=height, width=width - blind, do_rectify=False
    )
    return TYPES.types[DISPARITY](
        header=header,
        image=image(header, "32FC1", adjusted),
        f=geometry.focal,
        t=geometry.baseline,
        valid_window=window,
        min_disparity=least,
        max_disparity=most,
        delta_d=search.step,
    )


def depth_millimetres(header: Any, scene: Scene) -> Any:
    """Depth as `16UC1` in millimetres, 0 for none or for more than 65.535 m (REP 118)."""
    return image(header, "16UC1", millimetres(scene.depth)[0])


def depth_metres(header: Any, scene: Scene) -> Any:
    """Depth as `32FC1` in metres, NaN for none (REP 118)."""
    return image(header, "32FC1", scene.depth.astype(np.float32))


def confidence(header: Any, sure: NDArray[np.uint8]) -> Any:
    """Confidence as `mono8`, 255 the surest, 0 where nothing was measured."""
    return image(header, "mono8", sure)


def depth_uncertainty(header: Any, scene: Scene, disparity_error: float) -> Any:
    """The standard error of each depth as `32FC1` in metres, NaN for none; the disparity's is in pixels."""
    return image(header, "32FC1", scene.geometry.uncertainty(scene.depth, disparity_error))


def point_cloud(header: Any, scene: Scene) -> Any:
    """An unordered `sensor_msgs/PointCloud2` of the points with a depth: x, y, z, and rgb where known.

    ``rgb`` is a float whose bits are 0x00RRGGBB, as PCL and rviz read it.
    """
    points, colours, _ = scene.points()
    names = ["x", "y", "z"] + (["rgb"] if colours is not None else [])
    cloud = np.zeros(len(points), [(name, "<f4") for name in names])
    for k, name in enumerate("xyz"):
        cloud[name] = points[:, k]
    if colours is not None:
        red, green, blue = (colours[:, k].astype(np.uint32) for k in range(3))
        cloud["rgb"] = (red << 16 | green << 8 | blue).astype("<u4").view("<f4")
    field = TYPES.types["sensor_msgs/msg/PointField"]
    return TYPES.types[CLOUD](
        header=header,
        height=1,
        width=len(points),
        fields=[field(name=name, offset=4 * k, datatype=FLOAT32, count=1) for k, name in enumerate(names)],
        is_bigendian=False,
        point_step=cloud.dtype.itemsize,
        row_step=cloud.nbytes,
        data=cloud.view(np.uint8).ravel() if len(cloud) else np.zeros(0, np.uint8),
        is_dense=True,
    )
