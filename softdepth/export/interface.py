"""What you need to know to use a core: ports, fields, codes and timing, all taken from the core itself."""

from collections.abc import Iterator
from dataclasses import dataclass

from amaranth.hdl import Value
from amaranth.lib import data
from amaranth.lib.wiring import In

from softdepth.hdl.band_latency import BandLatency
from softdepth.hdl.core import StereoCore
from softdepth.hdl.costs.comparison import by_windows
from softdepth.hdl.signatures import COUNTER_BITS
from softdepth.hdl.text.rtlil import CLOCK, RESET, ports_of
from softdepth.hdl.text.rtlil import Port as Source
from softdepth.hdl.whole_latency import WholeLatency
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity

COLOURS = {1: ("gray",), 3: ("red", "green", "blue")}
"""A pixel's channels by their number, lowest bits first."""


@dataclass(frozen=True)
class Field:
    """Bits of a packed port: `width` from bit `low` on. Parts follow the field that holds them."""

    name: str
    low: int
    width: int
    meaning: str


@dataclass(frozen=True)
class Port:
    """A port of the exported module; `direction` is the module's: ``input`` or ``output``."""

    name: str
    direction: str
    width: int
    meaning: str
    fields: tuple[Field, ...] = ()


@dataclass(frozen=True)
class Interface:
    """An exported core from outside.

    Members
    -------
    name : of its module.
    ports : in the module's order.
    codes : validity codes that can occur.
    latency, full_rate_latency : clocks, as `BandLatency` states them of cores with a border band.
    whole : of cores without one, from which pixel `latency` counts, and what a frame takes.
    """

    name: str
    config: Config
    ports: tuple[Port, ...]
    codes: tuple[Validity, ...]
    latency: int
    full_rate_latency: int | None
    whole: WholeLatency | None = None


def interface_of(core: StereoCore, config: Config, name: str) -> Interface:
    """Describe `core`, which was made of `config`, as the module `name`."""
    ports = [Port(each, "input", 1, _MEANINGS[each]) for each in (CLOCK, RESET)]
    ports += [_port(source, config) for source in ports_of(core)]
    measured = (Validity.FULL, Validity.PARTIAL, Validity.BORDER)
    few = core.o.payload.shape()["code"].width == max(measured).bit_length()
    described = (name, config, tuple(ports), measured if few else tuple(Validity))
    if by_windows(config):
        band = BandLatency.of(config)
        return Interface(*described, band.idle, band.full_rate)
    whole = WholeLatency.of(config)
    return Interface(*described, whole.clocks, None, whole)


_MEANINGS = {
    CLOCK: "clock; all else is sampled at, and changes after, its rising edge",
    RESET: "synchronous reset, active high; one clock of it is enough",
    "i_payload": "a pair of pixels, held while i_valid waits for i_ready",
    "i_valid": "a pair is on offer; raise it without waiting for i_ready",
    "i_ready": "the pair is taken at this clock edge; may wait for i_valid, low during reset",
    "o_payload": "a result, held while o_valid waits for o_ready",
    "o_valid": "a result is on offer; never waits for o_ready",
    "o_ready": "the result is taken at this clock edge; 1 if you can always take one",
    "status": "counters of broken input since reset",
    "i_payload.left": "pixel of the left image",
    "i_payload.right": "pixel of the right image, at the same column and row",
    "i_payload.sof": "start of frame: 1 with a frame's first pixel",
    "i_payload.eol": "end of line: 1 with a line's last pixel",
    "i_payload.eof": "end of frame: 1 with a frame's last pixel; 0 for ever if the source cannot tell",
    "o_payload.disparity": "by how many pixels the match lies further left in the right image",
    "o_payload.code": "why this is a measurement, or is none: see the codes below",
    "o_payload.confidence": "how far the best candidate is ahead of others: 255 is surest, 0 if not measured",
    "o_payload.sof": "start of frame: 1 with a frame's first result",
    "o_payload.eol": "end of line: 1 with a line's last result",
    "o_payload.eof": "end of frame: 1 with a frame's last result",
    "o_payload.damaged": "the frame's input was broken before this result or at it",
    "status.short_lines": "lines that were too short, and were padded",
    "status.long_lines": "lines that were too long, and were cut",
    "status.early_starts": "starts of a frame before the end of the one before",
    "status.missing_starts": "times that pixels outside any frame were dropped",
}
"""The meaning of every port and field. A core with others cannot be exported: nobody would know them."""


def _port(source: Source, config: Config) -> Port:
    value = source.value
    fields = tuple(_fields(source.name, value.shape(), config)) if isinstance(value, data.View) else ()
    direction = "input" if source.flow is In else "output"
    return Port(source.name, direction, len(Value.cast(value)), _MEANINGS[source.name], fields)


def _fields(port: str, layout: data.Layout, config: Config) -> Iterator[Field]:
    for name, field in layout:
        meaning = _MEANINGS[f"{port}.{name}"]
        if name == "disparity" and (below := config.post.fraction_bits):
            meaning += f", times {2**below}: its lowest {below} bits are below a pixel"
        if port == "status":
            meaning += f"; stays at {2**COUNTER_BITS - 1}"
        yield Field(str(name), field.offset, field.width, meaning)
        if port == "i_payload" and name in ("left", "right"):
            pixel = config.pixel
            colours = COLOURS[pixel.channels]
            for k, colour in enumerate(colours if len(colours) > 1 else ()):
                low = field.offset + k * pixel.bits
                yield Field(f"{name}_{colour}", low, pixel.bits, f"its {colour}")
