"""Pairs out of bags: encodings, matching by time, and what is wrong with a bag."""

import shutil
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin

from softdepth.ros.bag import BagPair, Topics, count, opened, pairs
from softdepth.spec.errors import InputError
from tests.ros.conftest import BASELINE, DELAY, DOFFS, FOCAL, PERIOD, START, TOPICS, Recording, record


def read(path, topics: Topics = TOPICS, tolerance: float = 0.0) -> list[BagPair]:
    with opened(path) as reader:
        return list(pairs(reader, topics, tolerance=tolerance))


@pytest.mark.parametrize("storage", StoragePlugin)
@pytest.mark.parametrize(
    ("encoding", "channels", "dtype", "expected"),
    [
        ("rgb8", 3, np.uint8, lambda a: a),
        ("bgr8", 3, np.uint8, lambda a: a[..., ::-1]),
        ("mono8", 1, np.uint8, lambda a: a),
        ("mono16", 1, np.uint16, lambda a: a),
    ],
)
def test_raw_images(tmp_path, frames, storage, encoding, channels, dtype, expected):
    left, right = frames(3, channels, dtype, 1), frames(3, channels, dtype, 2)
    found = read(record(tmp_path / "bag", Recording(left, right, encoding, storage=storage)))
    assert len(found) == 3
    for k, pair in enumerate(found):
        np.testing.assert_array_equal(pair.left, expected(left[k]))
        np.testing.assert_array_equal(pair.right, expected(right[k]))
        assert pair.left.dtype == dtype
        assert pair.header.frame_id == "cam_left_optical"
        assert pair.received == START + PERIOD * (k + 1) + DELAY


def test_the_calibration_is_that_of_both_views(tmp_path, frames):
    (pair,) = read(record(tmp_path / "bag", Recording(frames(1), frames(1))))
    assert (pair.geometry.focal, pair.geometry.doffs) == (FOCAL, DOFFS)
    assert pair.geometry.baseline == pytest.approx(BASELINE)
    assert (pair.geometry.cx, pair.geometry.cy) == (9.5, 5.5)
    assert pair.geometry.frame_id == "cam_left_optical"


@pytest.mark.parametrize("channels", [1, 3])
def test_compressed_images(tmp_path, frames, channels):
    left, right = frames(1, channels, seed=1), frames(1, channels, seed=2)
    (pair,) = read(record(tmp_path / "bag", Recording(left, right, compressed="png")))
    np.testing.assert_array_equal(pair.left, left[0])
    np.testing.assert_array_equal(pair.right, right[0])


@pytest.mark.parametrize(
    ("encoding", "first"), [("bayer_rggb8", "red"), ("bayer_bggr8", "blue"), ("bayer_gbrg8", "green")]
)
def test_mosaics(tmp_path, encoding, first):
    """A scene of one colour: its mosaic has light where the filter has that colour."""
    order = {"bayer_rggb8": "RGGB", "bayer_bggr8": "BGGR", "bayer_gbrg8": "GBRG"}[encoding]
    colour = {"R": 200, "G": 120, "B": 40}
    mosaic = np.zeros((12, 20), np.uint8)
    for k, letter in enumerate(order):
        mosaic[k // 2 :: 2, k % 2 :: 2] = colour[letter]
    (pair,) = read(record(tmp_path / "bag", Recording([mosaic], [mosaic], encoding)))
    np.testing.assert_array_equal(pair.left[3:-3, 3:-3], np.full((6, 14, 3), (200, 120, 40)))


def test_only_equal_stamps_match_unless_told(tmp_path, frames):
    bag = record(tmp_path / "bag", Recording(frames(4), frames(4), stagger=2_000_000))
    assert read(bag) == []
    assert len(read(bag, tolerance=0.003)) == 4


def test_a_lost_image_costs_its_pair_only(tmp_path, frames):
    left, right = frames(6, seed=1), frames(6, seed=2)
    bag = record(tmp_path / "bag", Recording(left, right), lost={(TOPICS.right, 1), (TOPICS.right, 4)})
    found = read(bag)
    assert len(found) == 4
    for pair, k in zip(found, (0, 2, 3, 5), strict=True):
        np.testing.assert_array_equal(pair.left, left[k])
        np.testing.assert_array_equal(pair.right, right[k])


def test_images_are_counted(tmp_path, frames):
    with opened(record(tmp_path / "bag", Recording(frames(4), frames(4)))) as reader:
        assert count(reader, TOPICS) == 4


@pytest.mark.parametrize(
    ("topics", "message"),
    [
        (replace(TOPICS, left="/none"), "no topic '/none'; use one of /left/image_rect, /right/image_rect"),
        (replace(TOPICS, left_info="/none"), "use one of /left/camera_info, /right/camera_info"),
        (
            replace(TOPICS, right=TOPICS.right_info),
            "'/right/camera_info' holds sensor_msgs/msg/CameraInfo",
        ),
        (
            replace(TOPICS, left_info="/right/camera_info", right_info="/left/camera_info"),
            "and -focal * baseline is below 0; calibrate both cameras together, or exchange the topics",
        ),
    ],
)
def test_wrong_topics(tmp_path, frames, topics, message):
    bag = record(tmp_path / "bag", Recording(frames(1), frames(1)))
    with pytest.raises(InputError) as caught:
        read(bag, topics)
    assert message in str(caught.value)


def test_what_is_no_bag(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        read(tmp_path / "none")
    (tmp_path / "file.txt").write_text("no bag")
    with pytest.raises(InputError, match="is not a ROS 2 bag"):
        read(tmp_path / "file.txt")


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_file_without_its_folder_and_one_that_was_cut(tmp_path, frames, storage):
    folder = record(tmp_path / "bag", Recording(frames(2), frames(2, seed=1), storage=storage))
    (file,) = (each for each in folder.iterdir() if each.suffix in (".mcap", ".db3"))
    alone = Path(shutil.copy(file, tmp_path / file.name))
    assert len(read(alone)) == 2
    file.write_bytes(file.read_bytes()[:-500] if storage is StoragePlugin.MCAP else file.read_bytes()[:5000])
    with pytest.raises(InputError, match=r"that can be read \(.*mcap recover"):
        read(folder)


def test_without_calibration(tmp_path, frames):
    bag = record(tmp_path / "bag", Recording(frames(1), frames(1), infos=False))
    with pytest.raises(InputError, match="no topic '/left/camera_info'; record one of"):
        read(bag)


def test_an_encoding_that_is_unknown(tmp_path, frames):
    bag = record(tmp_path / "bag", Recording(frames(1, 1), frames(1, 1), "yuv422"))
    with pytest.raises(InputError, match="encoding 'yuv422'; use one of mono8"):
        read(bag)


def test_an_image_that_is_cut(tmp_path, frames):
    bag = record(tmp_path / "bag", Recording(frames(1, 1), frames(1, 1), "rgb8"))
    with pytest.raises(InputError, match="is cut"):
        read(bag)


def test_compressed_nonsense(tmp_path, frames, monkeypatch):
    monkeypatch.setattr(cv2, "imencode", lambda *_: (True, np.frombuffer(b"nonsense", np.uint8)))
    bag = record(tmp_path / "bag", Recording(frames(1), frames(1), compressed="png"))
    with pytest.raises(InputError, match="cannot be decoded"):
        read(bag)
