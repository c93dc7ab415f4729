"""Frames of results through a stage behind the winners."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.hdl.winners.layout import post_layout
from tests.support.simulation import stream_through

Array = NDArray[np.int64]
Fields = dict[str, Array]
FIELDS = ("value", "code", "confidence", "colour")
VALUE_BITS, COLOUR_BITS, CHANNELS, MAX_WIDTH = 6, 12, 3, 24


def random_fields(rng: np.random.Generator, height: int, width: int, measured: float = 0.6) -> Fields:
    """A frame of results; of those that are none, some are inconsistent and some are islands."""
    is_measured = rng.random((height, width)) < measured
    code = np.where(is_measured, rng.integers(0, 2, is_measured.shape), rng.integers(4, 6, is_measured.shape))
    return {
        "value": np.where(is_measured, rng.integers(0, 2**VALUE_BITS, is_measured.shape), 0),
        "code": code,
        "confidence": np.where(is_measured, rng.integers(1, 256, is_measured.shape), 0),
        # Few colours, so that some are alike.
        "colour": (rng.integers(0, 2**4, (height, width, CHANNELS)) << np.array([0, 4, 8])).sum(-1),
    }


def through(dut: Any, frames: list[Fields], **keys: Any) -> list[Fields]:
    """The frames that come out, their markers checked."""
    layout = post_layout(VALUE_BITS, COLOUR_BITS)
    sent = []
    for frame in frames:
        height, width = frame["value"].shape
        for y in range(height):
            for x in range(width):
                fields = {name: int(frame[name][y, x]) for name in FIELDS}
                sent.append(layout.const(fields | markers(y, x, height, width)).as_value().value)
    found = iter(stream_through(dut, sent, **keys).payloads)
    out = []
    for frame in frames:
        height, width = frame["value"].shape
        got = {name: np.zeros((height, width), np.int64) for name in FIELDS}
        for y in range(height):
            for x in range(width):
                result = next(found)
                for name in FIELDS:
                    got[name][y, x] = result[name]
                expected = markers(y, x, height, width)
                assert {name: result[name] for name in expected} == expected, (y, x)
        out.append(got)
    assert next(found, None) is None
    return out


def markers(y: int, x: int, height: int, width: int) -> dict[str, int]:
    """Of a pixel in a sound frame."""
    return {
        "sof": int((y, x) == (0, 0)),
        "eol": int(x == width - 1),
        "eof": int((y, x) == (height - 1, width - 1)),
        "damaged": 0,
    }


def check(found: list[Fields], expected: list[Fields]) -> None:
    """Every field of every pixel."""
    for number, (got, want) in enumerate(zip(found, expected, strict=True)):
        for name in FIELDS:
            wrong = np.argwhere(got[name] != want[name])
            assert not len(wrong), (number, name, wrong[0].tolist(), got[name], want[name])
