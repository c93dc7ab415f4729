"""ROS images to arrays: `sensor_msgs/Image` of the usual encodings, and `CompressedImage`."""

from typing import Any

import cv2
import numpy as np

from softdepth.spec.errors import InputError

ENCODINGS: dict[str, tuple[type, int, int | None]] = {
    "mono8": (np.uint8, 1, None),
    "8UC1": (np.uint8, 1, None),
    "mono16": (np.uint16, 1, None),
    "16UC1": (np.uint16, 1, None),
    "rgb8": (np.uint8, 3, None),
    "8UC3": (np.uint8, 3, cv2.COLOR_BGR2RGB),
    "bgr8": (np.uint8, 3, cv2.COLOR_BGR2RGB),
    "rgba8": (np.uint8, 4, cv2.COLOR_RGBA2RGB),
    "bgra8": (np.uint8, 4, cv2.COLOR_BGRA2RGB),
    "rgb16": (np.uint16, 3, None),
    "bgr16": (np.uint16, 3, cv2.COLOR_BGR2RGB),
    # OpenCV names a mosaic by its second row and column, ROS by its first.
    "bayer_rggb8": (np.uint8, 1, cv2.COLOR_BayerBG2RGB),
    "bayer_bggr8": (np.uint8, 1, cv2.COLOR_BayerRG2RGB),
    "bayer_gbrg8": (np.uint8, 1, cv2.COLOR_BayerGR2RGB),
    "bayer_grbg8": (np.uint8, 1, cv2.COLOR_BayerGB2RGB),
}
"""Each encoding's sample type, its channels, and OpenCV's conversion to RGB where one is needed."""


def to_array(message: Any, topic: str) -> np.ndarray:
    """The pixels of an image message: H x W for gray, H x W x 3 RGB for colour; uint8 or uint16.

    Raises `InputError` for an encoding that is not among `ENCODINGS`, and for data that does not fit the
    size that the message states.
    """
    if hasattr(message, "format"):
        return _decompressed(message, topic)
    if message.encoding not in ENCODINGS:
        raise InputError(
            f"images of '{topic}' have the encoding '{message.encoding}'",
            f"use one of {', '.join(ENCODINGS)}",
        )
    sample, channels, conversion = ENCODINGS[message.encoding]
    dtype = np.dtype(sample).newbyteorder(">" if message.is_bigendian else "<")
    used = message.width * channels * dtype.itemsize
    data = np.asarray(message.data, np.uint8)
    if message.step < used or data.size < message.step * message.height or not used:
        raise InputError(
            f"an image of '{topic}' is cut: {data.size} bytes for {message.width}x{message.height}"
            f" '{message.encoding}' in steps of {message.step}",
            "record the topic again",
        )
    rows = data[: message.step * message.height].reshape(message.height, message.step)[:, :used]
    image = np.ascontiguousarray(rows).view(dtype).astype(sample)
    image = image.reshape(message.height, message.width, channels)
    image = image[..., 0] if channels == 1 else image
    return image if conversion is None else cv2.cvtColor(image, conversion)


def _decompressed(message: Any, topic: str) -> np.ndarray:
    data = np.asarray(message.data, np.uint8)
    image = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if data.size else None
    if image is None or image.dtype not in (np.uint8, np.uint16):
        raise InputError(
            f"an image of '{topic}' cannot be decoded (format '{message.format}')",
            "use PNG or JPEG compression",
        )
    if image.ndim == 2:
        return image
    return cv2.cvtColor(image, cv2.COLOR_BGRA2RGB if image.shape[2] == 4 else cv2.COLOR_BGR2RGB)
