"""The layout of ``tdata``, after AMD's UG934 where that specifies it."""

from amaranth.hdl import Cat, Const, Value
from amaranth.lib import data

from softdepth.spec.config import Config, PixelFormat

BYTE = 8
DISPARITY_BITS = 16
"""A disparity fills two bytes; a signed one is sign-extended."""

CHANNELS = {1: (0,), 3: (1, 2, 0)}
"""A pixel's channels in ``tdata``, lowest first: gray; or green, blue, red, numbered as in the core."""


def whole_bytes(bits: int) -> int:
    """The next multiple of eight."""
    return -(-bits // BYTE) * BYTE


def pair_bits(pixel: PixelFormat) -> int:
    """Bits of ``tdata`` that holds both views' pixels: the left one lowest, the right one next, 0 above."""
    return whole_bytes(2 * pixel.size)


def view_bits(pixel: PixelFormat) -> int:
    """Bits of ``tdata`` that holds a pixel of one view, with 0 above it."""
    return whole_bytes(pixel.size)


def pixel_of(bits: Value, pixel: PixelFormat) -> Value:
    """A pixel in the core's order, red lowest, from one in UG934's order."""
    order = CHANNELS[pixel.channels]
    return Cat(bits.word_select(order.index(k), pixel.bits) for k in range(pixel.channels))


def bits_of(value: Value, pixel: PixelFormat) -> Value:
    """A pixel of the core in UG934's order: the reverse of `pixel_of`."""
    return Cat(value.word_select(channel, pixel.bits) for channel in CHANNELS[pixel.channels])


def outcome_layout(config: Config, *, left: bool = False) -> data.StructLayout:
    """``tdata`` of a result, byte by byte, lowest first; with its pixel of the left view on request."""
    return data.StructLayout(
        {
            "disparity": DISPARITY_BITS,
            "code": BYTE - 1,
            "damaged": 1,
            **({"confidence": BYTE} if config.post.confidence else {}),
            **({"left": view_bits(config.pixel)} if left else {}),
        }
    )


def extended(value: Value, signed: bool) -> Value:
    """A disparity extended to `DISPARITY_BITS`."""
    sign = value[-1] if signed else Const(0, 1)
    return Cat(value, sign.replicate(DISPARITY_BITS - len(value)))
