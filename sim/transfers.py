"""Images into packed stream payloads, and packed results back into maps."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from amaranth.lib.data import StructLayout
from numpy.typing import NDArray

from softdepth.golden.front.pair import Image, check_pair
from softdepth.golden.maps import DisparityMap
from softdepth.hdl.signatures import pair_layout, result_layout
from softdepth.spec.config import Config, PixelFormat
from softdepth.spec.errors import ToolError

Payloads = NDArray[Any]
"""Packed words: uint64, or Python integers where a word is longer."""

WORD_BITS = 64

RESULT = np.dtype(
    [
        ("disparity", "u2"),
        ("code", "u1"),
        ("confidence", "u1"),
        *((name, "?") for name in ("sof", "eol", "eof", "damaged")),
    ]
)
"""A result as NumPy sees it; the fields of `softdepth.hdl.signatures.result_layout`, 0 where it has none."""


def pack_frame(
    left: Image, right: Image, *, eof: bool = True, pixel: PixelFormat = PixelFormat.RGB8
) -> Payloads:
    """The transfers of one frame in raster order: images of `pixel` in, H*W `pair_layout` payloads out.

    `left` is what the core refers to. Without `eof` the frame's last pixel is not marked. Raises
    `InputError` for images that are not a pair.
    """
    check_pair(left, right, pixel)
    height, width = left.shape[:2]
    layout = pair_layout(pixel)
    words = (
        _words(image, pixel, layout) << layout[name].offset
        for name, image in (("left", left), ("right", right))
    )
    frame = np.bitwise_or(*words)
    marks = {name: _word(layout, 1 << layout[name].offset) for name in ("sof", "eol", "eof")}
    frame[0, 0] |= marks["sof"]
    frame[:, width - 1] |= marks["eol"]
    if eof:
        frame[height - 1, width - 1] |= marks["eof"]
    return frame.reshape(-1)


def unpack_results(payloads: Payloads, config: Config) -> NDArray[np.void]:
    """Packed results as an array of `RESULT` records, one for each payload."""
    layout = result_layout(config)
    results = np.zeros(payloads.shape, RESULT)
    for name in layout.members:
        results[name] = unpack_field(layout, name, payloads)
    return _signed(results, config.result_bits) if config.signed else results


def _signed(results: NDArray[np.void], bits: int) -> NDArray[np.void]:
    """Results whose disparities, of this many bits, are in two's complement."""
    kinds = [(name, "i2" if name == "disparity" else RESULT[name]) for name in RESULT.names or ()]
    found = results.astype(kinds)
    sign = 1 << bits - 1
    found["disparity"] = (results["disparity"].astype(np.int32) ^ sign) - sign
    return found


def split_frames(results: NDArray[np.void]) -> list[NDArray[np.void]]:
    """Consecutive `RESULT` records as frames, HxW each.

    Every frame must begin with ``sof``, end every line of the same length with ``eol`` and its last
    with ``eof``; raises `ToolError` naming the first place where the core's markers break that.
    """
    frames = []
    ends = np.flatnonzero(results["eof"]) + 1
    starts = np.concatenate(([0], ends))
    if starts[-1] != len(results):
        raise _malformed(
            len(ends), int(starts[-1]), f"the last {len(results) - starts[-1]} results have no eof"
        )
    for start, end in zip(starts[:-1].tolist(), ends.tolist(), strict=True):
        frame = results[start:end]
        width = int(np.argmax(frame["eol"])) + 1
        expected = {"sof": np.arange(len(frame)) == 0, "eol": np.arange(len(frame)) % width == width - 1}
        for marker, where in expected.items():
            wrong = np.flatnonzero(frame[marker] != where)
            if wrong.size:
                y, x = divmod(int(wrong[0]), width)
                raise _malformed(len(frames), start, f"{marker} at y={y} x={x} is {frame[marker][wrong[0]]}")
        if not frame["eol"][-1]:
            raise _malformed(len(frames), start, f"its {len(frame)} results are not whole lines of {width}")
        frames.append(frame.reshape(-1, width))
    return frames


def to_maps(frames: Sequence[NDArray[np.void]], config: Config) -> list[DisparityMap]:
    """Frames as `split_frames` gives them, as maps in the core's view."""
    post = config.post
    return [
        DisparityMap(
            frame["disparity"].copy(),
            frame["code"].copy(),
            post.fraction_bits,
            frame["confidence"].copy() if post.confidence else None,
        )
        for frame in frames
    ]


def unpack_field(layout: StructLayout, name: str, words: Payloads) -> Payloads:
    """One field of packed words."""
    field = layout[name]
    return (words >> _word(layout, field.offset)) & _word(layout, (1 << field.width) - 1)


def _word(layout: StructLayout, value: int) -> Any:
    """A word of the type that holds a layout's payloads."""
    return np.uint64(value) if layout.size <= WORD_BITS else value


def _words(image: Image, pixel: PixelFormat, layout: StructLayout) -> Payloads:
    """Gray, or red in the lowest bits, then green, then blue."""
    planes = image.reshape(*image.shape[:2], pixel.channels)
    planes = planes.astype(np.uint64 if layout.size <= WORD_BITS else object)
    return sum((planes[:, :, c] << (c * pixel.bits) for c in range(1, pixel.channels)), planes[:, :, 0])


def _malformed(frame: int, first: int, problem: str) -> ToolError:
    return ToolError(
        f"the core's results do not form frames: frame {frame}, from result {first}: {problem}",
        "this is a fault of the gateware; please report it with the configuration",
    )
