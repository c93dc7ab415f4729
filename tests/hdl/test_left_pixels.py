"""Results with their pixel of the left view, wherever in the core it comes from, in Amaranth's simulator."""

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from amaranth.lib import data

from softdepth.hdl import core as core_module
from softdepth.hdl.core import StereoCore
from softdepth.hdl.left_pixels import LeftPixels
from softdepth.hdl.memory import kept as kept_module
from softdepth.hdl.memory.kept import Kept
from softdepth.hdl.memory.long_queue import PART, LongQueue
from softdepth.hdl.memory.packed_memory import blocks as blocks_of
from softdepth.sim.transfers import pack_frame
from softdepth.spec.config import Config
from tests.cocotb.scenes import textured
from tests.support.mutations import mutated
from tests.support.simulation import Transfers, stream_through

SIZE = ["max_width=16", "max_height=8", "disparities=4", "lanes=4"]
WHOLE = [
    *SIZE,
    "criteria.0.rows=3",
    "criteria.0.columns=3",
    "post.island=0",
    "post.fill=false",
    "post.median=0",
]
FINE = "post.colour_bits=8"
CORES: dict[str, tuple[str, Config]] = {
    "windows": ("guard", Config.preset("sad").override(SIZE)),
    "results": ("results", Config.preset("robust-small").override([*WHOLE, FINE, "post.masked_median=0"])),
    "medians": (
        "masked_medians",
        Config.preset("robust-small").override([*WHOLE, FINE, "post.masked_median=1", "lanes=2"]),
    ),
    "overlap": (
        "guard",
        Config.preset("robust-small").override([*WHOLE, FINE, "post.masked_median=1", "min_disparity=-2"]),
    ),
    "coarse": ("guard", Config.preset("robust-small").override([*WHOLE, "post.masked_median=1"])),
    "not compared": ("results", Config.preset("robust-small").override([*WHOLE, "post.masked_median=0"])),
}
FRAMES = [textured(6, 16, 1), textured(4, 11, 2), textured(2, 16, 3)]
PAYLOADS = [pixel for pair in FRAMES for pixel in pack_frame(*pair).tolist()]
PATIENCE = 600


def lefts(payloads: list[int]) -> list[int]:
    """The left pixel of each pair, its lowest bits."""
    return [payload % (1 << 24) for payload in payloads]


@cache
def plain(name: str) -> Transfers:
    """A core without the pixels, at full rate."""
    return stream_through(StereoCore(CORES[name][1]), PAYLOADS, patience=PATIENCE)


def check(name: str, *, o_rate: float = 1.0) -> Transfers:
    """Each result has its own, and is what it is without."""
    config = CORES[name][1]
    found = stream_through(StereoCore(config, left=True), PAYLOADS, o_rate=o_rate, patience=PATIENCE)
    assert [result.left for result in found.payloads] == lefts(PAYLOADS)
    for got, want in zip(found.payloads, plain(name).payloads, strict=True):
        assert all(got[member] == want[member] for member in want.shape().members)
    return found


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.full if name != "windows" else ()) for name in CORES]
)
def test_each_result_has_its_pixel_and_none_waits_for_it(name: str) -> None:
    """At full rate the core takes and gives in the same clocks as without; frames are as wide as can be."""
    assert LeftPixels.of(CORES[name][1]).origin == CORES[name][0]
    found = check(name)
    assert found.taken == plain(name).taken
    assert found.given == plain(name).given


def test_results_that_are_held_back() -> None:
    check("windows", o_rate=0.2)


def test_too_few_places_make_the_core_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a quarter of a line it waits for itself."""
    less = LeftPixels("guard", CORES["windows"][1].max_width // 4)
    monkeypatch.setattr(core_module.LeftPixels, "of", lambda _: less)
    with pytest.raises(AssertionError, match="inputs were taken"):
        check("windows")


def check_unmarked() -> None:
    """Frames that end as the next one starts: by an item without a pixel."""
    pixels = [pixel for pair in FRAMES for pixel in pack_frame(*pair, eof=False).tolist()]
    found = stream_through(StereoCore(CORES["windows"][1], left=True), pixels, patience=PATIENCE)
    whole = sum(len(left) * len(left[0]) for left, _ in FRAMES[:-1])
    assert len(found.payloads) >= whole
    assert [result.left for result in found.payloads] == lefts(pixels)[: len(found.payloads)]


def test_ends_without_a_pixel() -> None:
    check_unmarked()


def test_a_pixel_of_an_end_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("softdepth.hdl.front.front.Kept", mutated(Kept, " & ~bare", ""))
    with pytest.raises(AssertionError):
        check_unmarked()


def test_a_pixel_that_is_kept_while_it_waits_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("softdepth.hdl.front.front.Kept", mutated(Kept, "& self.o.ready & ~bare", "& ~bare"))
    with pytest.raises(AssertionError):
        check("windows", o_rate=0.2)


def test_a_queue_of_several_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """It holds as many as it says, gives them in order, and loses none."""
    monkeypatch.setattr("softdepth.hdl.memory.long_queue.PART", 8)
    shape = data.StructLayout({"word": 12})
    queue = LongQueue(shape, 21)
    words = np.random.default_rng(1).integers(0, 1 << 12, 60).tolist()
    assert kept_module.LongQueue is LongQueue
    found = stream_through(queue, words)
    assert [item.word for item in found.payloads] == words
    assert found.given[0] - found.taken[0] == queue.latency
    assert found.given[-1] - found.given[0] == len(words) - 1
    slow = stream_through(LongQueue(shape, 21), words, o_rate=0.3)
    assert [item.word for item in slow.payloads] == words
    waiting = max(k + 1 - sum(given < taken for given in slow.given) for k, taken in enumerate(slow.taken))
    assert waiting >= 21


@pytest.mark.slow
def test_the_document_tells_the_memory(project: Path) -> None:
    """Block RAMs of the default cores."""
    text = (project / "docs" / "axi.md").read_text()
    sentence = r"In block RAMs of 18 kbit, at 1280 pixels per line, that is: (.*?)\.$"
    (told,) = re.findall(sentence, text, re.DOTALL | re.MULTILINE)
    found = [(name, int(number)) for name, number in re.findall(r"`([\w-]+)` (\d+)", told)]
    assert len(found) == 7
    for number, (name, blocks) in enumerate(found):
        shift = -5 if number == len(found) - 1 else 0
        config = Config.preset(name).override([f"min_disparity={shift}"])
        assert config.max_width == 1280
        whole, rest = divmod(LeftPixels.of(config).places, PART)
        size = config.pixel.size
        assert blocks == whole * blocks_of(size, PART) + blocks_of(size, rest), name
