"""Bags of depth, read back by mcap's own decoder, field by field."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import StoragePlugin

from softdepth.metric.scene import Choice
from softdepth.ros.bag import opened
from softdepth.ros.convert import Disparities, Further, RigTopics, convert
from softdepth.ros.messages import Search
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity
from tests.ros.conftest import (
    BASELINE,
    DELAY,
    DOFFS,
    FOCAL,
    HEIGHT,
    PERIOD,
    START,
    TOPICS,
    WIDTH,
    Recording,
    record,
)

RIG = RigTopics(TOPICS, "/stereo")
SEARCH = Search(least=0, most=5.9375, step=1 / 16)
DISPARITY = np.tile(np.linspace(0, 5.9375, WIDTH), (HEIGHT, 1))
CODE = np.full((HEIGHT, WIDTH), Validity.FULL, np.uint8)
CODE[0, :4] = [Validity.PARTIAL, Validity.FILLED, Validity.INCONSISTENT, Validity.NOTHING]
CONFIDENCE = np.full((HEIGHT, WIDTH), 200, np.uint8)
VALID = CODE != Validity.NOTHING
VALID[0, 2] = False
DEPTH = FOCAL * BASELINE / (DISPARITY + DOFFS)


def compute(pair) -> Disparities:
    return Disparities(DISPARITY, CODE, CONFIDENCE)


def read_back(folder: Path, *topics: str) -> list[Any]:
    """A bag's messages: each with its schema, channel, message and decoded message."""
    (file,) = folder.glob("*.mcap")
    with file.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        return list(reader.iter_decoded_messages(topics=topics or None))


@pytest.fixture
def left(frames) -> list[np.ndarray]:
    return frames(2, seed=1)


@pytest.fixture
def bag(tmp_path, left, frames) -> Path:
    return record(tmp_path / "bag", Recording(left, frames(2, seed=2)))


@pytest.fixture
def found(tmp_path, bag) -> dict[str, list]:
    """The messages of the converted bag by topic."""
    assert convert(bag, tmp_path / "depth", [RIG], compute, SEARCH).pairs == {"/stereo": 2}
    messages: dict[str, list] = {}
    for each in read_back(tmp_path / "depth"):
        messages.setdefault(each.channel.topic, []).append(each)
    return messages


def pixels(image, dtype: str) -> np.ndarray:
    assert image.is_bigendian == 0
    assert image.step == image.width * np.dtype(dtype).itemsize
    return np.frombuffer(bytes(image.data), dtype).reshape(image.height, image.width)


def test_types_times_and_frames(found):
    assert {topic: each[0].schema.name for topic, each in found.items()} == RIG.outputs()
    for messages in found.values():
        assert len(messages) == 2
        for k, each in enumerate(messages):
            header = each.decoded_message.header
            at = START + PERIOD * (k + 1)
            assert header.stamp.sec * 10**9 + header.stamp.nanosec == at
            assert header.frame_id == "cam_left_optical"
            assert each.message.log_time == at + DELAY


def test_disparity_image(found):
    message = found["/stereo/disparity"][0].decoded_message
    assert (message.f, message.delta_d) == (FOCAL, 1 / 16)
    assert message.t == pytest.approx(BASELINE)
    assert (message.min_disparity, message.max_disparity) == (DOFFS, 5.9375 + DOFFS)
    window = message.valid_window
    assert (window.x_offset, window.y_offset, window.width, window.height) == (6, 0, WIDTH - 6, HEIGHT)
    assert message.image.encoding == "32FC1"
    assert message.image.header.frame_id == "cam_left_optical"
    values = pixels(message.image, "<f4")
    np.testing.assert_allclose(values[VALID], (DISPARITY + DOFFS)[VALID], rtol=1e-6)
    assert (values[~VALID] < message.min_disparity).all()
    # stereo_image_proc's own reading: Z = f T / d
    np.testing.assert_allclose(message.f * message.t / values[VALID], DEPTH[VALID], rtol=1e-5)


def test_depth_images(found):
    raw, metres = (found[f"/stereo/depth/{name}"][1].decoded_message for name in ("image_raw", "image"))
    assert (raw.encoding, metres.encoding) == ("16UC1", "32FC1")
    expected = np.where(VALID, np.rint(DEPTH.astype(np.float32).astype(float) * 1000), 0)
    np.testing.assert_array_equal(pixels(raw, "<u2"), expected)
    np.testing.assert_array_equal(np.isnan(pixels(metres, "<f4")), ~VALID)
    np.testing.assert_allclose(pixels(metres, "<f4")[VALID], DEPTH[VALID], rtol=1e-6)


def test_point_cloud(found, left):
    message = found["/stereo/points2"][1].decoded_message
    assert [(f.name, f.offset, f.datatype, f.count) for f in message.fields] == [
        ("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1), ("rgb", 12, 7, 1),
    ]  # fmt: skip
    assert (message.height, message.width, message.point_step) == (1, VALID.sum(), 16)
    assert message.row_step == len(message.data) == 16 * VALID.sum()
    assert message.is_dense
    data = np.frombuffer(bytes(message.data), [("xyz", "<f4", 3), ("bgr_", "u1", 4)])
    y, x = np.nonzero(VALID)
    np.testing.assert_allclose(data["xyz"][:, 2], DEPTH[VALID], rtol=1e-6)
    np.testing.assert_allclose(data["xyz"][:, 0], DEPTH[VALID] * (x - 9.5) / FOCAL, atol=1e-6)
    np.testing.assert_allclose(data["xyz"][:, 1], DEPTH[VALID] * (y - 5.5) / FOCAL, atol=1e-6)
    np.testing.assert_array_equal(data["bgr_"][:, 2::-1], left[1][VALID])


def test_confidence_and_uncertainty(tmp_path, bag):
    further = Further(confidence=True, disparity_error=0.25)
    convert(bag, tmp_path / "out", [RIG], compute, SEARCH, further=further)
    found = {m.channel.topic: m for m in read_back(tmp_path / "out")}
    assert {topic: each.schema.name for topic, each in found.items()} == RIG.outputs(further)
    sure = found["/stereo/confidence"].decoded_message
    assert (sure.encoding, sure.header.frame_id) == ("mono8", "cam_left_optical")
    np.testing.assert_array_equal(pixels(sure, "u1"), CONFIDENCE)
    spread = found["/stereo/depth/uncertainty"].decoded_message
    assert spread.encoding == "32FC1"
    np.testing.assert_array_equal(np.isnan(pixels(spread, "<f4")), ~VALID)
    expected = DEPTH**2 / (FOCAL * BASELINE) * 0.25
    np.testing.assert_allclose(pixels(spread, "<f4")[VALID], expected[VALID], rtol=1e-5)


def test_confidence_of_a_core_that_has_none(tmp_path, bag):
    def without(pair) -> Disparities:
        return Disparities(DISPARITY, CODE)

    with pytest.raises(InputError, match="the core gives no confidence"):
        convert(bag, tmp_path / "out", [RIG], without, SEARCH, further=Further(confidence=True))
    assert not (tmp_path / "out").exists()


def test_what_was_filled_can_be_left_out(tmp_path, bag):
    convert(bag, tmp_path / "out", [RIG], compute, SEARCH, choice=Choice(measured_only=True))
    clouds = [m.decoded_message for m in read_back(tmp_path / "out", "/stereo/points2")]
    assert [cloud.width for cloud in clouds] == [VALID.sum() - 1] * 2


def test_sqlite_bags(tmp_path, bag):
    convert(bag, tmp_path / "out", [RIG], compute, SEARCH, storage="db3")
    with opened(tmp_path / "out") as reader:
        assert {c.topic: c.msgcount for c in reader.connections} == dict.fromkeys(RIG.outputs(), 2)


def test_several_rigs_each_with_its_own(tmp_path, frames):
    other = replace(
        TOPICS, left="/b/left", right="/b/right", left_info="/b/left/info", right_info="/b/right/info"
    )
    bag = record(
        tmp_path / "bag",
        Recording(frames(2), frames(2), storage=StoragePlugin.SQLITE3),
        Recording(frames(3, 1), frames(3, 1), "mono8", topics=other),
    )
    done = convert(bag, tmp_path / "out", [RIG, RigTopics(other, "/b")], compute, SEARCH)
    assert done.pairs == {"/stereo": 2, "/b": 3}
    topics = [m.channel.topic for m in read_back(tmp_path / "out")]
    assert topics.count("/b/points2") == 3


def test_nothing_half_written(tmp_path, bag):
    def fails(pair) -> Disparities:
        raise InputError("no", "never")

    with pytest.raises(InputError, match="no"):
        convert(bag, tmp_path / "out", [RIG], fails, SEARCH)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bag"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"storage": "bag"}, "unknown storage 'bag'; use one of db3, mcap"),
        ({"rigs": [RIG, RIG]}, "two rigs have the same namespace"),
    ],
)
def test_wrong_arguments(tmp_path, bag, change, message):
    arguments = {"rigs": [RIG], **change}
    with pytest.raises(InputError, match=message):
        convert(bag, tmp_path / "out", arguments.pop("rigs"), compute, SEARCH, **arguments)
    assert not (tmp_path / "out").exists()


def test_a_bag_is_not_written_over(tmp_path, bag):
    with pytest.raises(InputError, match="exists already"):
        convert(bag, bag, [RIG], compute, SEARCH)


def test_stamps_that_never_agree(tmp_path, frames):
    bag = record(tmp_path / "bag", Recording(frames(2), frames(2), stagger=10_000_000))
    with pytest.raises(InputError, match="allow for more with --tolerance"):
        convert(bag, tmp_path / "out", [RIG], compute, SEARCH)
    assert convert(bag, tmp_path / "out", [RIG], compute, SEARCH, tolerance=0.02).pairs == {"/stereo": 2}
