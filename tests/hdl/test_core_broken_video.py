"""The whole core on random broken video: every result of every frame, damaged or not, right after reset."""

from collections.abc import Iterator
from random import Random

import numpy as np
import pytest

from softdepth.golden.fixed_model import disparity
from softdepth.hdl.core import StereoCore
from softdepth.spec.config import Config
from tests.support.broken_video import broken_video, pauses
from tests.support.fault_table import Mended, mended
from tests.support.frames import Frame
from tests.support.mutations import FRAME_GUARD, HEIGHT_LEARNER, mutated_guard
from tests.support.simulation import config, pair, sad
from tests.support.trials import Outcome, Trial, run_trials

KEYS = {"max_width": 10, "max_height": 8}
CONFIGS: dict[str, Config] = {
    "3x3, all lanes": config(cost="sum", criteria=[sad(3)], disparities=3, lanes=3, **KEYS),
    "3x3, two steps": config(cost="sum", criteria=[sad(3)], disparities=4, lanes=2, **KEYS),
    "7x7, a stored row": config(cost="sum", criteria=[sad(7)], disparities=2, lanes=1, stored_rows=1, **KEYS),
}
SEEDS_OF_BROKEN = range(18)
"""One stream each; those that three divides have no pauses."""
Result = tuple[int, int, bool, bool, bool, bool]


def colours(number: int) -> tuple[tuple[int, int, int], tuple[int, int, int]]:
    """A left and a right pixel, few of them equal."""
    random = Random(number)
    left, right = (tuple(random.randrange(256) for _ in range(3)) for _ in range(2))
    return left, right  # type: ignore[return-value]


def packed(colour: tuple[int, int, int]) -> int:
    red, green, blue = colour
    return red | green << 8 | blue << 16


def results_of(frame: Frame, c: Config) -> Iterator[Result]:
    """A frame's results: the fixed model's, damaged where the pixel is that they leave with, or the end."""
    views = np.array([[colours(number) for number in line] for line in frame.lines], dtype=np.uint8)
    expected = disparity(views[:, :, 0], views[:, :, 1], c)
    height, width = expected.code.shape
    behind = c.reach_rows * width + c.reach_right
    for k in range(height * width):
        y, x = divmod(k, width)
        damaged = frame.damaged[k + behind] if k + behind < height * width else frame.damaged[-1]
        value, code = int(expected.disparity[y, x]), int(expected.code[y, x])
        yield value, code, k == 0, x == width - 1, k == height * width - 1, damaged


def first_difference(c: Config, seeds: range) -> str:
    tables: list[Mended] = []
    found: list[str] = []

    def trials() -> Iterator[Trial]:
        for seed in seeds:
            stream, _ = broken_video(seed, c)
            tables.append(mended(stream, c))
            sent = [pair(*map(packed, colours(p.value)), sof=p.sof, eol=p.eol, eof=p.eof) for p in stream]
            yield Trial(sent, *((1.0, 1.0) if seed % 3 else (0.7, 0.7)), pauses=pauses(stream, c))

    def judge(number: int, outcome: Outcome) -> bool:
        frames, counters = tables[number]
        complete = [frame for frame in frames if frame.end != "open"]
        expected = [result for frame in complete for result in results_of(frame, c)]
        got = [
            (int(o.disparity), int(o.code), bool(o.sof), bool(o.eol), bool(o.eof), bool(o.damaged))
            for o in outcome.payloads
        ]
        if got[: len(expected)] != expected or outcome.status != counters:
            pairs = zip(got, expected, strict=False)
            at = next(
                (k for k, (one, other) in enumerate(pairs) if one != other), min(len(got), len(expected))
            )
            found.append(
                f"seed {seeds[number]}, result {at}: {got[at : at + 1]} and not {expected[at : at + 1]}"
                f"; {outcome.status} and not {counters}"
            )
        return not found

    run_trials(StereoCore(c), trials(), judge, patience=120)
    return found[0] if found else ""


@pytest.mark.slow
@pytest.mark.parametrize("name", CONFIGS)
def test_what_leaves_is_what_the_table_says(name: str) -> None:
    assert not first_difference(CONFIGS[name], SEEDS_OF_BROKEN)


@pytest.mark.parametrize(
    "mutation",
    [
        (HEIGHT_LEARNER, "m.If(whole & agrees):", "m.If(whole):"),
        (FRAME_GUARD, "damaged.eq(so_far)", "damaged.eq(0)"),
    ],
    ids=["one frame teaches a height", "damage is forgotten"],
)
def test_a_core_with_a_broken_guard_is_caught(
    mutation: tuple[str, str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("softdepth.hdl.front.front.FrameGuard", mutated_guard(*mutation))
    assert first_difference(CONFIGS["3x3, all lanes"], range(24))
