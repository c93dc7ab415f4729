"""The payloads of the core's streams, and its status port.

Both streams are raster scans. Markers travel in the payload, so that a frame needs no side channel
and any stall pattern leaves it intact.
"""

from amaranth.hdl import Shape, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.spec.config import CONFIDENCE_BITS, Config, PixelFormat
from softdepth.spec.post import ISLAND_BITS, LIKE_MAX

COUNTER_BITS = 16
TOLERANCE_BITS = 4


def pixel_layout(pixel: PixelFormat) -> data.ArrayLayout:
    """A pixel: its channels, red lowest."""
    return data.ArrayLayout(pixel.bits, pixel.channels)


def colour_size(config: Config) -> int:
    """Bits of the colour that travels with a result to the stages behind the winners."""
    return config.pixel.channels * config.colour_bits


def pair_layout(pixel: PixelFormat) -> data.StructLayout:
    """Input payload: a rectified pixel pair and its markers.

    ``left``, ``right`` hold gray, or red in the lowest bits, then green, then blue. ``sof`` marks a
    frame's first pixel, ``eol`` a line's last, ``eof`` a frame's last. A source without ``eof`` ties it to
    0: a frame then ends at the next ``sof``, until two whole frames in a row have taught the core their
    height, and in the silence behind its last line from then on.
    """
    return data.StructLayout(
        {"left": unsigned(pixel.size), "right": unsigned(pixel.size), "sof": 1, "eol": 1, "eof": 1}
    )


def result_layout(config: Config, *, left: bool = False) -> data.StructLayout:
    """Output payload: ``disparity`` in units of ``2**-fraction_bits`` pixels, its `Validity` code, its
    ``confidence`` where the core gives one, on request its pixel of the left view, and its markers.

    ``damaged`` is set from the first result after a break in the input (a short or long line, a
    misplaced start of frame) to the frame's end.
    """
    return data.StructLayout(
        {
            "disparity": Shape(config.result_bits, signed=config.signed),
            "code": unsigned(config.code_bits),
            **({"confidence": unsigned(CONFIDENCE_BITS)} if config.post.confidence else {}),
            **({"left": unsigned(config.pixel.size)} if left else {}),
            "sof": 1,
            "eol": 1,
            "eof": 1,
            "damaged": 1,
        }
    )


STEERING = ("hold", "skip", "clear", "forget")
"""Of the settings, what the first room looks at."""


def threshold_limits(config: Config) -> dict[str, tuple[int, int]]:
    """Least and greatest value of thresholds that are looked at far inside (`softdepth.hdl.thresholds`).

    ``compensated``: SADs above it are compensated. ``truncation``: of the gradient, where there is one.
    ``like``: of the masked medians, in units of 8-bit values.
    """
    limits: dict[str, tuple[int, int]] = {}
    judged = config.compensation_criterion
    if config.compensation.reading != "off" and judged is not None:
        limits["compensated"] = (0, config.maxima[judged])
    if gradient := config.gradient:
        cut = min(gradient.truncation, 2 * gradient.cap)
        limits["truncation"] = (min(gradient.neutral, cut), cut)
    if config.post.masked_median:
        limits["like"] = (0, LIKE_MAX)
    return limits


def thresholds_layout(config: Config) -> data.StructLayout:
    """Of the settings, `threshold_limits`."""
    return data.StructLayout({name: range(high + 1) for name, (_, high) in threshold_limits(config).items()})


def settings_layout(config: Config) -> data.StructLayout:
    """What a core that takes settings is told while it runs; thresholds where the configuration has them.

    ``hold``: no frame begins: its first pixel waits. ``skip``: frames that begin are dropped whole.
    ``clear``: the counters of broken input begin at 0. ``forget``: nothing is known any more of how the
    source ends its frames. The others are the configuration's, and may change while no frame is inside.
    """
    post = config.post
    return data.StructLayout(
        {
            **dict.fromkeys(STEERING, 1),
            **({"tolerance": unsigned(TOLERANCE_BITS)} if post.check else {}),
            **({"island": unsigned(ISLAND_BITS)} if post.island else {}),
            **thresholds_layout(config).members,
        }
    )


def settings_ports(config: Config) -> dict[str, wiring.Member]:
    """The ports that a core has besides when it takes settings."""
    return {"settings": In(settings_layout(config)), "faults": Out(Faults)}


Status = data.StructLayout(
    {
        "short_lines": unsigned(COUNTER_BITS),
        "long_lines": unsigned(COUNTER_BITS),
        "early_starts": unsigned(COUNTER_BITS),
        "missing_starts": unsigned(COUNTER_BITS),
    }
)
"""Saturating counters of broken input since reset.

``short_lines``: lines padded to the frame's width with their last pixel. ``long_lines``: lines cut
to the frame's or the core's width. ``early_starts``: a start of frame before the running frame's
end. ``missing_starts``: times that pixels outside any frame were dropped.
"""

Faults = data.StructLayout(dict.fromkeys(Status.members, 1))
"""Which of the faults of `Status` was met in the clock before."""
