"""Sequencer: one result a pixel, in raster order, with the pixel that completes its support."""

from dataclasses import dataclass, field
from random import Random
from typing import Any, NamedTuple

import pytest
from amaranth.hdl import Cat, Signal, Value
from amaranth.sim import SimulatorContext

from softdepth.hdl.front.frame_guard import item_layout
from softdepth.hdl.front.sequencer import Sequencer, tags_layout
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity
from tests.support.expected import code
from tests.support.simulation import config, sad, simulate


class Sent(NamedTuple):
    """A frame for the sequencer: its size, how it ends, and the pixel from which it is damaged."""

    width: int
    height: int
    end: str = "eof"
    damaged_from: int | None = None


class Tags(NamedTuple):
    code: int
    sof: int
    eol: int
    eof: int
    damaged: int


class Step(NamedTuple):
    """A clock with ``valid``."""

    clock: int
    first: int
    last: int
    step: int
    first_of_line: int
    first_inner: int


@dataclass
class Record:
    """What the sequencer did, and in which clocks."""

    loads: list[int] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    emits: list[tuple[int, Tags]] = field(default_factory=list)
    issues: list[int] = field(default_factory=list)


def items(frames: list[Sent], c: Config) -> list[dict[str, Any]]:
    support = c.reach_left + c.reach_right
    sent: list[dict[str, Any]] = []
    for frame in frames:
        pixels = frame.width * frame.height
        is_damaged = [frame.damaged_from is not None and k >= frame.damaged_from for k in range(pixels + 1)]
        for k in range(pixels):
            x = k % frame.width
            last = k == pixels - 1
            sent.append(
                {"x": x, "sof": k == 0, "eol": x == frame.width - 1, "eof": last and frame.end == "eof"}
                | {"damaged": is_damaged[k], "first": x == 0, "completes": k > 0 and x == c.reach_right}
                | {"inner": k > 0 and x >= support, "first_inner": k > 0 and x == support}
            )
        if frame.end == "end":
            sent.append({"end": 1, "damaged": is_damaged[pixels]})
    return sent


def run(
    c: Config, frames: list[Sent], *, i_rate: float = 1.0, credits: int = 1000, return_rate: float = 1.0
) -> Record:
    """Run frames through. A result's credit comes back some time after it was emitted."""
    dut = Sequencer(c)
    layout = item_layout(c)
    packed = [layout.const(item).as_value().value for item in items(frames, c)]
    loads_of = [k for k, item in enumerate(items(frames, c)) if not item.get("end")]
    random = Random(len(packed))
    record = Record()
    outputs = Cat(
        dut.i.ready, dut.load, dut.valid, dut.first, dut.last, dut.emit, dut.issued, Value.cast(dut.tags)
    )
    tags_of = tags_layout()

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        sent = clock = quiet = emitted = returned = 0
        offered = False
        while quiet < 8 * c.steps + 60:
            if not offered and sent < len(packed) and random.random() < i_rate:
                offered = True
                ctx.set(Value.cast(dut.i.payload), packed[sent])
            ctx.set(dut.i.valid, offered)
            credit = credits + returned - len(record.issues)
            ctx.set(dut.credit, credit > 1)  # this clock may take one
            _, _, bits, step, line, inner = await ctx.tick().sample(
                outputs, dut.step, dut.first_of_line, dut.first_inner
            )
            ready, load, valid, first, last, emit, issued = (bits >> k & 1 for k in range(7))
            quiet += 1
            if valid:
                record.steps.append(Step(clock, first, last, step, line, inner))
            if load:
                assert sent == loads_of[len(record.loads)], f"clock {clock}: not a pixel"
                record.loads.append(clock)
            assert not load or (offered and ready), f"clock {clock}: a load without a pixel taken"
            if offered and ready:
                assert load == (sent in loads_of[len(record.loads) - 1 :][:1]), "a pixel was lost"
                sent, offered, quiet = sent + 1, False, 0
            if issued:
                assert credit > 0, f"clock {clock}: a result was promised without a credit"
                record.issues.append(clock)
            if emit:
                tags = tags_of.from_bits(bits >> 7)
                record.emits.append((clock, Tags(*(int(tags[name]) for name in Tags._fields))))
                emitted, quiet = emitted + 1, 0
            if returned < emitted and random.random() < return_rate:
                returned += 1
            clock += 1
        assert sent == len(packed), f"only {sent} of {len(packed)} items were taken"

    simulate(dut, bench)
    return record


def expected_tags(c: Config, frame: Sent) -> list[Tags]:
    """The results of a frame. Damage shows from the first result that leaves with a damaged pixel."""
    pixels = frame.width * frame.height
    behind = c.reach_rows * frame.width + c.reach_right
    damaged_from = pixels + 1 if frame.damaged_from is None else frame.damaged_from
    return [
        Tags(
            code(k % frame.width, k // frame.width, frame.width, frame.height, c),
            k == 0,
            k % frame.width == frame.width - 1,
            k == pixels - 1,
            min(k + behind, pixels) >= damaged_from,
        )
        for k in range(pixels)
    ]


def check(c: Config, frames: list[Sent], record: Record) -> None:
    """Results, and the pixel each leaves with."""
    expected = [tags for frame in frames for tags in expected_tags(c, frame)]
    assert [tags for _, tags in record.emits] == expected
    assert len(record.issues) == len(expected)
    for (emitted, _), issued in zip(record.emits, record.issues, strict=True):
        assert 0 < emitted - issued <= c.steps

    # Every pixel takes all its steps, from the clock after its load, and its flags stay through them.
    assert len(record.steps) == len(record.loads) * c.steps
    columns = [k % frame.width for frame in frames for k in range(frame.width * frame.height)]
    support = c.reach_left + c.reach_right
    for n, (loaded, x) in enumerate(zip(record.loads, columns, strict=True)):
        assert record.steps[n * c.steps : (n + 1) * c.steps] == [
            (loaded + 1 + k, k == 0, k == c.steps - 1, k, x == 0, x == support) for k in range(c.steps)
        ]

    base = 0
    for frame in frames:
        for k in range(frame.width * frame.height):
            x, y = k % frame.width, k // frame.width
            at_x, at_y = x + c.reach_right, y + c.reach_rows
            emitted, tags = record.emits[base + k]
            behind = k + c.reach_rows * frame.width + c.reach_right
            if behind < frame.width * frame.height:
                assert emitted == record.loads[base + behind] + c.steps, (
                    "not with the pixel that completes it"
                )
            if tags.code < Validity.BORDER:
                assert behind == at_y * frame.width + at_x
        base += frame.width * frame.height


CONFIGS = {
    "3x3, one step": config(cost="sum", criteria=[sad(3)], disparities=4, lanes=4),
    "3x3, four steps": config(cost="sum", criteria=[sad(3)], disparities=4, lanes=1),
    "5x5, three steps": config(cost="sum", criteria=[sad(5)], disparities=6, lanes=2),
    "lite": config(criteria=[sad(3, -2), sad(3), sad(3, 2)], disparities=6, lanes=3),
    "nothing to the right": config(cost="sum", criteria=[sad(3, -1)], disparities=4, lanes=2),
    "far to the right": config(cost="sum", criteria=[sad(3, 5)], disparities=4, lanes=2),
}


def frames_of(c: Config) -> list[Sent]:
    """Frames of several sizes, the smallest included, some twice in a row."""
    w, h = max(c.min_width, 2), c.min_height
    return [
        Sent(w + 3, h + 2),
        Sent(w + 3, h + 2),
        Sent(w, h),
        Sent(w + 7, h + 1, "end"),
        Sent(w + 1, h + 2, "end", (w + 1) * (h + 2)),
        Sent(w + 5, h + 1),
    ]


@pytest.mark.parametrize("i_rate", [1.0, 0.4])
@pytest.mark.parametrize("name", CONFIGS)
def test_results_in_raster_order(name: str, i_rate: float) -> None:
    c = CONFIGS[name]
    check(c, frames_of(c), run(c, frames_of(c), i_rate=i_rate))


@pytest.mark.parametrize(("credits", "rate"), [(2, 1.0), (2, 0.3), (3, 0.5), (6, 0.3)])
@pytest.mark.parametrize("name", ["3x3, one step", "3x3, four steps", "nothing to the right"])
def test_no_result_without_a_credit(name: str, credits: int, rate: float) -> None:
    c = CONFIGS[name]
    frames = frames_of(c)[:4]
    check(c, frames, run(c, frames, credits=credits, return_rate=rate, i_rate=0.8))


@pytest.mark.parametrize("name", ["3x3, one step", "3x3, four steps", "5x5, three steps", "lite"])
@pytest.mark.parametrize("extra", [0, 1, 6])
def test_frames_of_one_size_follow_without_a_gap(name: str, extra: int) -> None:
    c = CONFIGS[name]
    frames = [Sent(c.min_width + extra, c.min_height + extra)] * 3
    record = run(c, frames)
    check(c, frames, record)
    assert record.loads == [record.loads[0] + c.steps * k for k in range(len(record.loads))]
    with_pixels = record.emits[: len(record.loads) - frames[0].width * c.reach_rows - c.reach_right]
    clocks = [clock for clock, _ in with_pixels]
    assert clocks == [clocks[0] + c.steps * k for k in range(len(clocks))]


@pytest.mark.parametrize("name", ["3x3, four steps", "5x5, three steps"])
def test_the_last_results_leave_by_themselves(name: str) -> None:
    c = CONFIGS[name]
    frame = Sent(c.min_width + 4, c.min_height + 1)
    record = run(c, [frame])
    check(c, [frame], record)
    alone = frame.width * c.reach_rows + c.reach_right
    last = record.loads[-1] + c.steps
    clocks = [clock for clock, _ in record.emits[-alone:]]
    assert clocks == list(range(last + 1, last + 1 + alone))  # one a clock, no pixel needed


@pytest.mark.parametrize("end", ["eof", "end"])
@pytest.mark.parametrize("name", ["3x3, one step", "3x3, four steps", "5x5, three steps", "lite"])
def test_frames_lower_than_the_support_are_all_border(name: str, end: str) -> None:
    c = CONFIGS[name]
    w = c.min_width
    frames = [Sent(w + 2, height, end) for height in range(1, c.min_height)]
    frames += [Sent(w + 2, c.min_height), Sent(w + 3, 1, end), Sent(w + 1, 1, end), Sent(w + 2, c.min_height)]
    record = run(c, frames)
    check(c, frames, record)
    low = sum(frame.width * frame.height for frame in frames[: c.min_height - 1])
    assert {tags.code for _, tags in record.emits[:low]} == {Validity.BORDER}


@pytest.mark.parametrize("end", ["eof", "end"])
@pytest.mark.parametrize("damaged_from", [0, 1, 17, 30, 34])
def test_damage_shows_from_the_break_to_the_end_of_the_frame(damaged_from: int, end: str) -> None:
    c = CONFIGS["3x3, four steps"]
    frames = [Sent(7, 5), Sent(7, 5, end, damaged_from), Sent(7, 5)]
    check(c, frames, run(c, frames))
    assert any(tags.damaged for tags in expected_tags(c, frames[1]))
