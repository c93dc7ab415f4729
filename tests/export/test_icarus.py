"""An exported core in Icarus, against the fixed model: from time 0 on, under both standards, without an X."""

import json
import re
from itertools import chain
from pathlib import Path

import numpy as np
import pytest

from softdepth.cli.info import facts
from softdepth.export.core_file import export_core
from softdepth.golden.fixed_model import disparity
from softdepth.hdl.costs.comparison import by_windows
from softdepth.sim.transfers import pack_frame, split_frames, to_maps, unpack_results
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity
from tests.export.conftest import SIZE, SMALL, exported
from tests.hdl.test_core import images
from tests.support.icarus import Seen, needs_icarus, run_icarus

pytestmark = needs_icarus

Pair = tuple[np.ndarray, np.ndarray]


def pairs_for(config: Config) -> list[Pair]:
    width, height = config.min_width + 5, config.min_height + 1 + 4 * (not by_windows(config))
    pairs = [images(1, width, height), images(2, width, height, 3)]
    return [of_pixel(pair, config) for pair in pairs]


def of_pixel(pair: Pair, config: Config) -> Pair:
    """A colour pair, or its green channels."""
    return pair if config.pixel.channels > 1 else (pair[0][:, :, 1], pair[1][:, :, 1])


def check(seen: Seen, pairs: list[Pair], config: Config) -> None:
    """Every pixel of every frame; no X, and nothing taken in reset."""
    assert not seen.complaints
    frames = split_frames(unpack_results(np.array(seen.payloads, np.uint64), config))
    assert len(frames) == len(pairs)
    for found, pair in zip(to_maps(frames, config), pairs, strict=True):
        expected = disparity(*pair, config)
        assert np.array_equal(found.disparity, expected.disparity)
        assert np.array_equal(found.code, expected.code)
        assert np.array_equal(found.confidence, expected.confidence)
    assert not any(frame["damaged"].any() for frame in frames)
    assert seen.status == 0


def pixels(pairs: list[Pair], config: Config) -> list[int]:
    return list(chain.from_iterable(pack_frame(*pair, pixel=config.pixel).tolist() for pair in pairs))


@pytest.mark.parametrize(("standard", "reset_clocks"), [("-g2005", 1), ("-g2012", 1), ("-g2012", 40)])
@pytest.mark.parametrize("name", SMALL)
def test_frames_equal_the_fixed_model(name: str, standard: str, reset_clocks: int, tmp_path: Path) -> None:
    """Pixels are on offer from time 0 on, in reset as well: the core takes none of them then."""
    config, pairs = SMALL[name], pairs_for(SMALL[name])
    text = exported(name).verilog
    seen = run_icarus(
        text,
        pixels(pairs, config),
        tmp_path,
        standard=standard,
        reset_clocks=reset_clocks,
        stalls=reset_clocks > 1,
    )
    check(seen, pairs, config)
    assert seen.taken[0] >= reset_clocks


@pytest.mark.parametrize("name", SMALL)
def test_what_memories_hold_at_first_never_shows(name: str, tmp_path: Path) -> None:
    """Synthesis is told of no initial words: with any, results are the same."""
    config, pairs = SMALL[name], pairs_for(SMALL[name])
    text, changed = re.subn(r"(\w+\[word\]) = \d+'h0;", r"\1 = {16{$random}};", exported(name).verilog)
    assert changed > 1
    check(run_icarus(text, pixels(pairs, config), tmp_path), pairs, config)


def test_the_bench_sees_an_unknown_bit_and_a_lost_pixel(tmp_path: Path) -> None:
    config, pairs = SMALL["sad"], pairs_for(SMALL["sad"])
    text = exported("sad").verilog
    unknown = re.sub(r"(memory\[\w+\] <= )[^;]*;", r"\1'bx;", text)  # the result queue's memory
    assert unknown != text
    assert any(
        line.startswith("X") for line in run_icarus(unknown, pixels(pairs, config), tmp_path).complaints
    )
    cut = re.sub(r"\.(\w+)\(i_ready\)", r".\1()", text.split("\nmodule ", 1)[1])  # behind the head's example
    always_ready = re.sub(r"^  wire i_ready;$", "  wire i_ready = 1'b1;", cut, flags=re.MULTILINE)
    assert always_ready != cut != text
    always_ready = "module " + always_ready
    seen = run_icarus(always_ready, pixels(pairs, config), tmp_path, reset_clocks=3)
    assert any(line.startswith("W") for line in seen.complaints)
    with pytest.raises(AssertionError):
        check(seen, pairs, config)


CORES = [
    *((preset, 16, lanes) for preset in ("sad", "lite") for lanes in (1, 2, 4, 16)),
    *(("paper", 8, lanes) for lanes in (1, 2, 4, 8)),
]
SEEN_OUTSIDE = {("sad", 16, 4): 27, ("lite", 19, 1): 88, ("sad", 64, 1): 211}
"""Clocks at full rate, as benches that know nothing of `BandLatency` have counted them."""


@pytest.mark.parametrize(("preset", "disparities", "lanes"), [*CORES, ("lite", 19, 1), ("sad", 64, 1)])
def test_latencies_are_as_stated(preset: str, disparities: int, lanes: int, tmp_path: Path) -> None:
    """By head, JSON and `info` alike: from the last pixel that a result needs, in both conditions."""
    config = Config.preset(preset).override([*SIZE, f"disparities={disparities}", f"lanes={lanes}"])
    core = export_core(config)
    pair = images(1, config.min_width + 3, config.min_height + 1)
    width = pair[0].shape[1]
    behind = config.reach_rows * width + config.reach_right

    def latencies(gap: int) -> set[int]:
        seen = run_icarus(core.verilog, pixels([pair], config), tmp_path, gap=gap)
        assert not seen.complaints
        # The queues have filled when the first of these pixels comes.
        return {seen.given[k] - seen.taken[k + behind] for k in range(len(seen.taken) - behind)}

    (idle,), (full,) = latencies(4 * config.steps), latencies(0)
    assert SEEN_OUTSIDE.get((preset, disparities, lanes), full) == full
    (stated,) = re.findall(
        r"can be taken (\d+) clocks after that pixel is, where pixels come slowly, and (\d+) clocks after it",
        re.sub(r"\n//\s+", " ", core.verilog),
    )
    assert stated == (str(idle), str(full))
    assert f'"latency": {idle},' in core.json
    assert f'"latency_at_full_rate": {full},' in core.json
    found = facts(config, 100, 64, 48)
    assert found["latency"].startswith(f"{idle} clocks after")
    assert found["latency at full rate"].startswith(f"{full} clocks where")


WHOLE = ["max_width=16", "max_height=32", "disparities=4", "lanes=2"]
FULL = [pytest.mark.full, pytest.mark.slow]
UNCHECKED = "post.check=false"
NO_STAGE = ["post.island=0", "post.median=0", "post.masked_median=0", "post.fill=false"]
STAGES = [
    NO_STAGE,
    [*NO_STAGE, "post.fraction_bits=0", "post.confidence=false"],
    [*NO_STAGE, "post.fill=true"],
    [*NO_STAGE, "post.island=4"],
    [*NO_STAGE, "post.median=5"],
    [*NO_STAGE, "post.masked_median=2"],
    ["post.masked_median=2", "post.median=5"],
]
LANES = (1, 2, 4)
COMBINATIONS = [
    [f"lanes={lanes}", "pixel=gray8", check, *stages]
    for lanes in LANES
    for check in (UNCHECKED, "post.check=true")
    for stages in STAGES
]
"""One lane, two, and all; with the check and without; no stage behind the winners, each alone, and all."""
QUICK = COMBINATIONS[: len(STAGES) : len(STAGES) - 1]
"""One lane without the check: no stage, and all."""


@pytest.mark.parametrize(
    ("preset", "changes"),
    [
        ("robust-small", []),
        *(
            pytest.param("robust-small", each, marks=[] if each in QUICK else FULL, id=" ".join(each))
            for each in COMBINATIONS
        ),
        pytest.param("robust", ["post.masked_median=0", "pixel=gray8"], marks=FULL),
        pytest.param("robust", ["pixel=gray8", UNCHECKED, *NO_STAGE], marks=FULL),
        pytest.param("robust-small", ["pixel=gray8", UNCHECKED, "min_disparity=-2"], marks=FULL),
        pytest.param("robust-small", ["pixel=gray8", UNCHECKED, "min_disparity=2"], marks=FULL),
        pytest.param("paper", ["post.check=true"], marks=FULL),
        pytest.param("paper", ["post.fraction_bits=4"], marks=FULL),
        pytest.param("sad", ["post.check=true", "post.island=4"], marks=FULL),
        pytest.param("sad", ["post.check=true"], marks=FULL),
        pytest.param("sad", ["post.island=4"], marks=FULL),
    ],
)
def test_latencies_of_sums_down_columns(preset: str, changes: list[str], tmp_path: Path) -> None:
    """A line's last result, from the pixel that the head names, where pixels come slowly.

    Of lines as short as the head allows, and of eight pixels at least: some are to be measured.
    """
    config = Config.preset(preset).override([*WHOLE, *changes])
    core = export_core(config)
    needs = json.loads(core.json)["needs"]
    text = re.sub(r"\n//\s+", " ", core.verilog)
    (narrowest,) = re.findall(r"lines have at least (\d+)", text)
    width, height = max(int(narrowest), 8), needs["rows"] + 2
    pair = of_pixel(images(1, width, height), config)
    seen = run_icarus(
        core.verilog, pixels([pair], config), tmp_path, gap=(width + 15) * config.steps, patience=2000
    )
    check(seen, [pair], config)
    # What is filled waits for other results of its line.
    measured = (disparity(*pair, config).code[:, -1] < Validity.BORDER) | (not config.post.fill)
    times = {
        seen.given[y * width + width - 1] - seen.taken[(y + needs["rows"]) * width + needs["column"]]
        for y in range(height - needs["rows"])
        if measured[y]
    }
    (stated,) = re.findall(
        rf"up to column {needs['column']} of line y \+ {needs['rows']}\. With o_ready at 1 the line's last"
        r" can be taken (\d+) clocks after that pixel is, where pixels come slowly",
        text,
    )
    assert times == {int(stated)}
    assert f'"latency": {stated},' in core.json
    assert facts(config, 100, 16, 16)["latency"].startswith(f"{stated} clocks after")


def test_frames_without_a_border_band_follow_as_stated(tmp_path: Path) -> None:
    """Clocks between the first pixels of two frames, where pixels are always on offer, and by `info`."""
    config = Config.preset("robust-small").override([*WHOLE, "pixel=gray8"])
    pairs = [of_pixel(images(seed, 12, 20), config) for seed in range(4)]
    seen = run_icarus(export_core(config).verilog, pixels(pairs, config), tmp_path, patience=2000)
    check(seen, pairs, config)
    apart = np.diff(seen.taken[:: 12 * 20])
    assert facts(config, 100, 12, 20)["clocks per frame"] == f"{apart[-1]} at 12x20"
