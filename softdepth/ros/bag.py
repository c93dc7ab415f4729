"""Stereo pairs out of a ROS 2 bag: two image topics and their `camera_info`, matched by time."""

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.highlevel import AnyReader, AnyReaderError
from rosbags.typesys import Stores, get_typestore

from softdepth.rig.geometry import Geometry
from softdepth.ros.images import to_array
from softdepth.spec.errors import InputError

TYPES = get_typestore(Stores.ROS2_HUMBLE)
"""Message definitions for bags that carry none; those that are used here are the same in all later ROS 2."""

IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
INFO = "sensor_msgs/msg/CameraInfo"
WAITING = 64
"""How many images of each topic wait for their partner at most."""


@dataclass(frozen=True)
class Topics:
    """The topics of a rig: both views, and the calibration of each, as rectified."""

    left: str
    right: str
    left_info: str
    right_info: str


@dataclass(frozen=True, eq=False)
class BagPair:
    """Two images of one moment.

    Members
    -------
    left, right : H x W or H x W x 3 RGB, uint8 or uint16.
    header : the left image's, which results carry on.
    received : when the bag got the left image, in nanoseconds.
    geometry : from the latest `camera_info` of both views.
    """

    left: np.ndarray
    right: np.ndarray
    header: Any
    received: int
    geometry: Geometry


@contextmanager
def opened(path: Path) -> Iterator[AnyReader]:
    """A bag for reading (folder of .db3 or .mcap files); raises `InputError` if it is none."""
    if not path.exists():
        raise InputError(f"'{path}' does not exist", "give the folder of a ROS 2 bag")
    try:
        reader = AnyReader([path], default_typestore=TYPES)
        reader.open()
    except (AnyReaderError, OSError, ValueError, KeyError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(
            f"'{path}' is not a ROS 2 bag that can be read ({reason})",
            "give its folder with metadata.yaml, or its one .mcap or .db3; where a recorder was killed,"
            " repair it with: mcap recover FILE, or: ros2 bag reindex FOLDER",
        ) from error
    try:
        yield reader
    finally:
        reader.close()


def count(reader: AnyReader, topics: Topics) -> int:
    """Images of the left view in the bag: the most pairs that there can be."""
    return sum(each.msgcount for each in reader.connections if each.topic == topics.left)


def pairs(reader: AnyReader, topics: Topics, *, tolerance: float = 0.0) -> Iterator[BagPair]:
    """The bag's stereo pairs in the order of their time stamps.

    Two images are a pair when the stamps in their headers differ by no more than `tolerance` seconds; by
    default they must be equal, as synchronised cameras stamp them. Images without a partner are left out.

    Raises `InputError` for a topic that the bag lacks or that holds another kind of message, for images
    before any `camera_info`, and for a calibration that is not a rectified pair's.
    """
    connections = [_connection(reader, topic, IMAGES) for topic in (topics.left, topics.right)]
    connections += [_connection(reader, topic, (INFO,)) for topic in (topics.left_info, topics.right_info)]
    waiting: dict[str, deque[tuple[int, int, Any]]] = {topics.left: deque(), topics.right: deque()}
    infos: dict[str, Any] = {}
    reach = round(tolerance * 1e9)
    for connection, received, raw in reader.messages(connections):
        message: Any = reader.deserialize(raw, connection.msgtype)
        if connection.msgtype == INFO:
            infos[connection.topic] = message
            continue
        queue = waiting[connection.topic]
        queue.append((_nanoseconds(message.header.stamp), received, message))
        while len(queue) > WAITING:
            queue.popleft()
        while (match := _match(waiting[topics.left], waiting[topics.right], reach)) is not None:
            (_, received_left, left), (_, _, right) = match
            if missing := [name for name in (topics.left_info, topics.right_info) if name not in infos]:
                raise InputError(
                    f"images come before any message of '{missing[0]}'",
                    "record camera_info from the start on",
                )
            geometry = geometry_of(infos[topics.left_info], infos[topics.right_info], left.header.frame_id)
            images = to_array(left, topics.left), to_array(right, topics.right)
            yield BagPair(*images, left.header, received_left, geometry)


def geometry_of(left: Any, right: Any, frame_id: str) -> Geometry:
    """The geometry that two `camera_info` messages state by P, the projection after rectification.

    ``P[3]`` of the right view is ``-f B``: ROS states the baseline through it. Raises `InputError` if it
    does not, or where the views differ in focal length or principal row.
    """
    p_left, p_right = (np.asarray(info.p, float).reshape(3, 4) for info in (left, right))
    focal = p_left[0, 0]
    if focal <= 0:
        raise InputError(f"camera_info of the left view has P[0] = {focal:g}", "calibrate the rig")
    if p_right[0, 3] >= 0:
        raise InputError(
            f"camera_info of the right view has P[3] = {p_right[0, 3]:g}, and -focal * baseline is below 0",
            "calibrate both cameras together, or exchange the topics",
        )
    for name, place in (("focal lengths", (0, 0)), ("principal rows", (1, 2))):
        if abs(p_left[place] - p_right[place]) > 1e-3 * focal:
            raise InputError(
                f"the {name} of the views differ: {p_left[place]:g} and {p_right[place]:g}",
                "rectify the images, and record their camera_info",
            )
    return Geometry(
        focal=float(focal),
        baseline=float(-p_right[0, 3] / p_right[0, 0]),
        doffs=float(p_right[0, 2] - p_left[0, 2]),
        cx=float(p_left[0, 2]),
        cy=float(p_left[1, 2]),
        frame_id=frame_id or left.header.frame_id,
    )


def _connection(reader: AnyReader, topic: str, kinds: tuple[str, ...]) -> Any:
    found = [each for each in reader.connections if each.topic == topic]
    if not found:
        fitting = sorted({each.topic for each in reader.connections if each.msgtype in kinds})
        raise InputError(
            f"the bag has no topic '{topic}'",
            f"use one of {', '.join(fitting)}" if fitting else f"record one of {' or '.join(kinds)}",
        )
    if found[0].msgtype not in kinds:
        raise InputError(f"'{topic}' holds {found[0].msgtype}", f"name a topic of {' or '.join(kinds)}")
    return found[0]


def _match(
    left: deque[tuple[int, int, Any]], right: deque[tuple[int, int, Any]], reach: int
) -> tuple[tuple[int, int, Any], tuple[int, int, Any]] | None:
    """Take the first two whose stamps agree, and drop what is older than they are."""
    while left and right:
        ahead = left[0][0] - right[0][0]
        if abs(ahead) <= reach:
            return left.popleft(), right.popleft()
        (right if ahead > 0 else left).popleft()
    return None


def _nanoseconds(stamp: Any) -> int:
    return stamp.sec * 10**9 + stamp.nanosec
