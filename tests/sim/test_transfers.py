"""Packing agrees with the gateware's layouts, and malformed rasters are found."""

import numpy as np
import pytest

from softdepth.hdl.signatures import pair_layout, result_layout
from softdepth.sim.transfers import RESULT, pack_frame, split_frames, to_maps, unpack_results
from softdepth.spec.config import Config, PixelFormat
from softdepth.spec.errors import InputError, ToolError

HEIGHT, WIDTH = 9, 12


@pytest.mark.parametrize("eof", [True, False])
def test_packs_as_the_gateware_unpacks(pair: tuple[np.ndarray, np.ndarray], eof: bool) -> None:
    left, right = pair
    transfers = pack_frame(left, right, eof=eof)
    assert transfers.shape == (HEIGHT * WIDTH,)
    for number, word in enumerate(transfers.tolist()):
        y, x = divmod(number, WIDTH)
        pixel = pair_layout(PixelFormat.RGB8).from_bits(word)
        assert pixel.left.to_bytes(3, "little") == left[y, x].tobytes()
        assert pixel.right.to_bytes(3, "little") == right[y, x].tobytes()
        assert pixel.sof == (number == 0)
        assert pixel.eol == (x == WIDTH - 1)
        assert pixel.eof == (eof and number == HEIGHT * WIDTH - 1)


def test_refuses_what_is_no_pair(pair: tuple[np.ndarray, np.ndarray]) -> None:
    with pytest.raises(InputError, match="12x9"):
        pack_frame(pair[0], pair[1][:, :5])


@pytest.mark.parametrize("preset", ["paper", "robust"])
def test_unpacks_every_field_of_a_result(preset: str) -> None:
    config = Config.preset(preset)
    layout = result_layout(config)
    rng = np.random.default_rng(5)
    words = rng.integers(0, 2**layout.size, 200, dtype=np.uint64)
    for word, result in zip(words.tolist(), unpack_results(words, config), strict=True):
        expected = layout.from_bits(word)
        fields = {name: expected[name] for name, _ in layout}
        assert {name: int(result[name]) for name in RESULT.names or ()} == {"confidence": 0} | fields


def raster(height: int, width: int) -> np.ndarray:
    frame = np.zeros((height, width), RESULT)
    frame["disparity"] = np.arange(height * width).reshape(height, width)
    frame["sof"][0, 0] = True
    frame["eol"][:, -1] = True
    frame["eof"][-1, -1] = True
    return frame.reshape(-1)


def test_splits_frames_of_different_sizes() -> None:
    frames = split_frames(np.concatenate([raster(3, 4), raster(2, 5), raster(1, 1)]))
    assert [frame.shape for frame in frames] == [(3, 4), (2, 5), (1, 1)]
    maps = to_maps(frames, Config.preset("sad"))
    assert maps[1].disparity.tolist() == [[0, 1, 2, 3, 4], [5, 6, 7, 8, 9]]
    assert maps[1].code.shape == (2, 5)


@pytest.mark.parametrize(
    ("marker", "place", "value", "message"),
    [
        ("sof", 0, False, r"frame 1, from result 12: sof at y=0 x=0 is False"),
        ("sof", 5, True, r"frame 1.*sof at y=1 x=1 is True"),
        ("eol", 7, False, r"frame 1.*eol at y=1 x=3 is False"),
        ("eol", 5, True, r"frame 1.*eol at y=1 x=1 is True"),
        ("eof", 11, False, r"frame 1, from result 12: the last 12 results have no eof"),
        ("eof", 5, True, r"frame 1.*not whole lines of 4"),
    ],
)
def test_finds_a_misplaced_marker(marker: str, place: int, value: bool, message: str) -> None:
    second = raster(3, 4)
    second[marker][place] = value
    with pytest.raises(ToolError, match=message):
        split_frames(np.concatenate([raster(3, 4), second]))
