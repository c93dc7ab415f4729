"""The stage that a mismatch speaks of is the one that is at fault."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.golden.front.pair import Image
from softdepth.golden.maps import DisparityMap
from softdepth.sim.stage import explain
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity

CONFIG = Config.preset("paper").override(
    [
        *("disparities=8", "lanes=4"),
        *("compensation.reading=top", "compensation.from_disparity=3", "compensation.threshold=700"),
    ]
)
RIGHT = CONFIG.override(["reference=right"])
SHAPE = (16, 40, 3)
X, Y = 18, 8
"""A pixel that sees every candidate, some of them better than its own in a criterion."""


@pytest.fixture
def pair() -> tuple[Image, Image]:
    """Noise, in which every detail of a cost decides."""
    left, right = np.random.default_rng(7).integers(0, 90, (2, *SHAPE)).astype(np.uint8)
    return left, right


def stages(config: Config, pair: tuple[Image, Image], got: DisparityMap, limit: int = 5) -> list[str]:
    lines = explain(config, [pair], [fixed_model.disparity(*pair, config)], [got], limit)
    return [line.partition("; stage: ")[2] for line in lines]


def copied(found: DisparityMap) -> DisparityMap:
    return DisparityMap(found.disparity.copy(), found.code.copy())


def test_equal_maps_have_none(pair: tuple[Image, Image]) -> None:
    assert stages(CONFIG, pair, fixed_model.disparity(*pair, CONFIG)) == []


@pytest.mark.parametrize("config", [CONFIG, RIGHT], ids=lambda config: config.reference)
@pytest.mark.parametrize(
    ("stage", "change"),
    [
        (
            "line buffer (as of the line above)",
            lambda c, a, b: fixed_model.disparity(*(np.roll(i, 1, 0) for i in (a, b)), c),
        ),
        (
            "line buffer (as of the line below)",
            lambda c, a, b: fixed_model.disparity(*(np.roll(i, -1, 0) for i in (a, b)), c),
        ),
        (
            "criteria (as of the pixel to the right)",
            lambda c, a, b: fixed_model.disparity(*(np.roll(i, -1, 1) for i in (a, b)), c),
        ),
        (
            "right columns (as of the other image, moved by a pixel)",
            lambda c, a, b: fixed_model.disparity(
                *((np.roll(a, 1, 1), b) if c.reference == "right" else (a, np.roll(b, -1, 1))), c
            ),
        ),
        (
            "compensating rule (as without it)",
            lambda c, a, b: fixed_model.disparity(a, b, c.override(["compensation.reading=off"])),
        ),
    ],
    ids=lambda value: value.partition(" (")[0] if isinstance(value, str) else "",
)
def test_a_fault_of_the_whole_frame(
    pair: tuple[Image, Image], config: Config, stage: str, change: Callable[..., Any]
) -> None:
    found = stages(config, pair, change(config, *pair), limit=1000)
    assert len(found) > 30
    assert all(text.startswith(f"{stage}, in all ") for text in found)


def test_the_sad_minimum_instead_of_the_fuzzy_one(pair: tuple[Image, Image]) -> None:
    expected = fixed_model.disparity(*pair, CONFIG)
    got = copied(expected)
    for y, x in np.argwhere(expected.valid).tolist():
        got.disparity[y, x] = fixed_model.trace(*pair, CONFIG, x, y).criteria[:, 1].argmin()
    (found, *_) = stages(CONFIG, pair, got)
    assert found.startswith("inference (as by criterion 2 alone), in all ")


@pytest.mark.parametrize("code", [Validity.PARTIAL, Validity.BORDER])
def test_a_wrong_code_is_the_sequencers(pair: tuple[Image, Image], code: Validity) -> None:
    got = copied(fixed_model.disparity(*pair, CONFIG))
    got.code[Y, X] = code
    assert stages(CONFIG, pair, got) == ["sequencer (validity code)"]


def test_a_borders_disparity(pair: tuple[Image, Image]) -> None:
    got = copied(fixed_model.disparity(*pair, CONFIG))
    got.disparity[0, 0] = 1
    assert stages(CONFIG, pair, got) == ["results (a border pixel's disparity is 0)"]


def test_an_excluded_candidate(pair: tuple[Image, Image]) -> None:
    got = copied(fixed_model.disparity(*pair, CONFIG))
    got.disparity[Y, CONFIG.reach_left + 2] = 3
    assert stages(CONFIG, pair, got) == ["exclusion (the candidate's window leaves the other image)"]


def test_a_tie() -> None:
    flat = np.full(SHAPE, 9, np.uint8)
    got = copied(fixed_model.disparity(flat, flat, CONFIG))
    got.disparity[Y, X] = 5
    assert stages(CONFIG, (flat, flat), got) == ["argmin (both candidates cost the same)"]


@pytest.mark.parametrize(
    ("config", "stages_named"),
    [
        (CONFIG, {"criteria or inference", "criteria, inference or argmin"}),
        (
            Config.preset("sad").override(["disparities=8", "lanes=4"]),
            {"criteria or argmin"},
        ),
    ],
    ids=["fuzzy", "sum"],
)
def test_a_dearer_candidate(pair: tuple[Image, Image], config: Config, stages_named: set[str]) -> None:
    """The criteria of both candidates decide whether argmin is among the stages; the costs are told."""
    expected = fixed_model.disparity(*pair, config)
    trace = fixed_model.trace(*pair, config, X, Y)
    best = trace.disparity
    named = set()
    for d in set(range(config.disparities)) - {best}:
        got = copied(expected)
        got.disparity[Y, X] = d
        (found,) = stages(config, pair, got)
        n, s = trace.numerator, trace.denominator
        assert found.endswith(f"; {best} costs {n[best]}/{s[best]}, {d} costs {n[d]}/{s[d]}")
        stage = found.partition(" (")[0].partition(";")[0]
        worse = (trace.criteria[d] >= trace.criteria[best]).all()
        assert config.cost == "sum" or (stage == "criteria, inference or argmin") == worse
        named.add(stage)
    assert named == stages_named
