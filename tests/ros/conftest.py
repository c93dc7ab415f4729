"""Small bags, written as a camera driver would."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer

from softdepth.ros.bag import INFO, TYPES, Topics

WIDTH, HEIGHT, FOCAL, BASELINE, DOFFS = 20, 12, 80.0, 0.1, 1.5
TOPICS = Topics("/left/image_rect", "/right/image_rect", "/left/camera_info", "/right/camera_info")
START = 1_700_000_000 * 10**9
"""When the calibration is sent, in nanoseconds."""
PERIOD = 10**8
DELAY = 7_000_000
"""Nanoseconds from an image's stamp to its arrival in the bag."""


@dataclass
class Recording:
    """What a bag is made of: frames of both views, how they are coded, and when they were taken."""

    left: list[np.ndarray]
    right: list[np.ndarray]
    encoding: str = "rgb8"
    compressed: str = ""
    stagger: int = 0
    infos: bool = True
    storage: StoragePlugin = StoragePlugin.MCAP
    topics: Topics = TOPICS


def header(at: int, frame_id: str) -> Any:
    """A header of a time in nanoseconds."""
    stamp = TYPES.types["builtin_interfaces/msg/Time"](sec=at // 10**9, nanosec=at % 10**9)
    return TYPES.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame_id)


def camera_info(head: Any, baseline: float, doffs: float) -> Any:
    p = [FOCAL, 0, 9.5 + doffs, -FOCAL * baseline, 0, FOCAL, 5.5, 0, 0, 0, 1, 0]
    k = [FOCAL, 0, 9.5 + doffs, 0, FOCAL, 5.5, 0, 0, 1]
    region = TYPES.types["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False)
    return TYPES.types[INFO](
        header=head,
        height=HEIGHT,
        width=WIDTH,
        distortion_model="plumb_bob",
        d=np.zeros(5),
        k=np.array(k, float),
        r=np.eye(3).ravel(),
        p=np.array(p, float),
        binning_x=0,
        binning_y=0,
        roi=region,
    )


def image_message(head: Any, pixels: np.ndarray, recording: Recording) -> tuple[str, Any]:
    if recording.compressed:
        kind = "sensor_msgs/msg/CompressedImage"
        shown = pixels[..., ::-1] if pixels.ndim == 3 else pixels
        _, data = cv2.imencode(f".{recording.compressed}", shown)
        return kind, TYPES.types[kind](header=head, format=recording.compressed, data=data.ravel())
    padded = np.zeros((pixels.shape[0], pixels[0].nbytes + 3), np.uint8)  # drivers pad rows
    padded[:, :-3] = np.ascontiguousarray(pixels).view(np.uint8).reshape(pixels.shape[0], -1)
    kind = "sensor_msgs/msg/Image"
    return kind, TYPES.types[kind](
        header=head,
        height=pixels.shape[0],
        width=pixels.shape[1],
        encoding=recording.encoding,
        is_bigendian=0,
        step=padded.shape[1],
        data=padded.ravel(),
    )


def record(path: Path, *recordings: Recording, lost: Collection[tuple[str, int]] = ()) -> Path:
    """Write a bag of the recordings in the order of time; `lost` are topics, each with a frame's number."""
    storage = recordings[0].storage
    written: list[tuple[int, str, str, Any]] = []
    for each in recordings:
        if each.infos:
            for topic, baseline, doffs in (
                (each.topics.left_info, 0.0, 0.0),
                (each.topics.right_info, BASELINE, DOFFS),
            ):
                written.append((START, topic, INFO, camera_info(header(START, "cam"), baseline, doffs)))
        for k, views in enumerate(zip(each.left, each.right, strict=True)):
            taken = START + PERIOD * (k + 1)
            topics = (each.topics.left, each.topics.right)
            for topic, pixels, at in zip(topics, views, (taken, taken + each.stagger), strict=True):
                if (topic, k) in lost:
                    continue
                message = image_message(header(at, "cam_left_optical"), pixels, each)
                written.append((at + DELAY, topic, *message))
    with Writer(path, version=8, storage_plugin=storage) as writer:
        connections: dict[str, Any] = {}
        for at, topic, kind, message in sorted(written, key=lambda entry: entry[0]):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=TYPES)
            writer.write(connections[topic], at, TYPES.serialize_cdr(message, kind))
    return path


@pytest.fixture
def frames() -> Callable[..., list[np.ndarray]]:
    """`count` random frames, gray or RGB."""

    def made(count: int, channels: int = 3, dtype: type = np.uint8, seed: int = 0) -> list[np.ndarray]:
        random = np.random.default_rng(seed)
        shape = (HEIGHT, WIDTH, 3) if channels == 3 else (HEIGHT, WIDTH)
        return [random.integers(0, np.iinfo(dtype).max + 1, shape, dtype) for _ in range(count)]

    return made
