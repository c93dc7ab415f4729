"""Maps of a reading, against plain loops over the images; margins; OpenCV's matchers."""

from dataclasses import replace

import numpy as np
import pytest

from softdepth.golden.maps import DisparityMap
from softdepth.studies.paper import matchers, prototype, readings
from softdepth.studies.paper.cells import Cell, compute, metrics, rmse
from softdepth.studies.paper.margins import Margins
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.scenes import Scene
from tests.studies.paper.conftest import HEIGHT, WIDTH, scene

CANDIDATES = 12
SMALL = {
    reading.name: replace(reading, candidates=CANDIDATES, size=None)
    for reading in (readings.SAD, *readings.FMCDM.values())
}
STEPS = scene("teddy")


def sad_loop(reading: Reading, x: int, y: int, d: int, window: int) -> int | None:
    """SAD of one window with replicated edges; None where the candidate is excluded."""
    r = window // 2
    sign = -1 if reading.view == "left" else 1
    here, there = (STEPS.left, STEPS.right) if reading.view == "left" else (STEPS.right, STEPS.left)
    reach = max(reading.windows) // 2
    edge = x + sign * (d + reach)
    if reading.leaving == "excluded" and not 0 <= edge < WIDTH:
        return None
    total = 0
    for yy in range(y - r, y + r + 1):
        row = min(max(yy, 0), HEIGHT - 1)
        for xx in range(x - r, x + r + 1):
            a = here[row, min(max(xx, 0), WIDTH - 1)].astype(int)
            b = there[row, min(max(xx + sign * d, 0), WIDTH - 1)].astype(int)
            total += int(np.abs(a - b).sum())
    return total


@pytest.mark.parametrize("name", ["sad", "nest-357", "nest-579"])
def test_float_maps_follow_their_reading(name):
    reading = SMALL[name]
    operator = None if reading.method == "sad" else "min"
    found = compute(Cell("teddy", reading, operator, "float"), STEPS)
    assert found.disparity.shape == (HEIGHT, WIDTH)
    for y in (0, 1, 9, HEIGHT - 1):
        for x in (0, 1, 3, 5, 40, WIDTH - 14, WIDTH - 6, WIDTH - 5, WIDTH - 2, WIDTH - 1):
            sums = [[sad_loop(reading, x, y, d, w) for w in reading.windows] for d in range(CANDIDATES)]
            sums = [each for each in sums if None not in each]
            inside = reading.blank <= min(x, y, WIDTH - 1 - x, HEIGHT - 1 - y)
            assert found.valid[y, x] == (bool(sums) and inside), (x, y)
            if not sums or not inside:
                continue
            columns = [np.array(c) for c in zip(*sums, strict=True)]
            costs = columns[0] if operator is None else prototype.cost(columns, operator, reading.label)
            assert found.disparity[y, x] == int(costs.argmin()), (x, y)


@pytest.mark.parametrize("reading", SMALL.values(), ids=SMALL)
def test_margins_come_off_again(reading):
    margins = Margins.of(reading, reading.config())
    columns = np.tile(np.arange(WIDTH, dtype=np.uint8)[:, None], (HEIGHT, 1, 3))
    extended = margins.extend(columns)
    codes = np.zeros(extended.shape[:2], np.uint8)
    cropped = margins.crop(DisparityMap(extended[:, :, 0].astype(np.uint16), codes))
    np.testing.assert_array_equal(cropped.disparity, columns[:, :, 0])


def test_the_rule_looks_at_its_judge():
    # Two pictures of noise: any candidate may win, and the 3x3 sums lie around the rule's 1200.
    rng = np.random.default_rng(4)
    left, right = rng.integers(0, 135, (2, HEIGHT, WIDTH, 3), dtype=np.uint8)
    noise = Scene("noise", left, right, {}, "noise")
    reading = replace(SMALL["nest-357"], candidates=40)
    cell = Cell("noise", reading, "soft_min_1", "float")
    judged = (replace(cell, rule="top", judge=judge) for judge in (1, 3))
    none, small, large = (compute(each, noise).disparity for each in (cell, *judged))
    assert 0 < (small != none).sum() < (large != none).sum()
    assert (none[large != none] >= 32).all()  # the rule rejects far candidates only
    assert (large < 32).all()  # every 7x7 sum is above 1200


def test_the_prototype_sums_each_channel_alone():
    reading = replace(readings.PROTOTYPE, candidates=8, windows=(3, 3, 3), view="left")
    found = prototype.disparity(STEPS.left, STEPS.right, reading, "min")
    for y, x in ((5, 3), (20, 60), (HEIGHT - 1, 0)):
        rows, columns = (np.clip(range(n - 1, n + 2), 0, m - 1) for n, m in ((y, HEIGHT), (x, WIDTH)))
        criteria = np.empty((3, 8), int)
        for d in range(8):
            partner = np.clip(np.arange(x - 1, x + 2) - d, 0, WIDTH - 1)
            a = STEPS.left[np.ix_(rows, columns)].astype(int)
            b = STEPS.right[np.ix_(rows, partner)].astype(int)
            criteria[:, d] = np.abs(a - b).sum((0, 1))
        assert found[y, x] == int(prototype.cost(list(criteria), "min", reading.label).argmin())


def test_fixed_and_float_see_the_same_border():
    for reading in SMALL.values():
        operator = None if reading.method == "sad" else "mean"
        fixed, model = (compute(Cell("teddy", reading, operator, e), STEPS) for e in ("fixed", "float"))
        np.testing.assert_array_equal(fixed.valid, model.valid)
        # Half of the true partners are not among these candidates: such pixels may differ.
        assert (fixed.disparity != model.disparity).mean() < 0.3


def test_drawing_and_scoring():
    reading = replace(SMALL["nest-357"], first=1)
    truth = STEPS.truths["right"]
    found = compute(Cell("teddy", reading, "mean", "float"), STEPS)
    drawn = 4.0 * (found.disparity + 1)
    assert rmse(found, reading, STEPS) == pytest.approx(np.sqrt(np.mean((drawn - truth.gray) ** 2)))
    other = replace(reading, truth="left")
    assert rmse(found, other, STEPS) > rmse(found, reading, STEPS)
    assert metrics(found, other, STEPS) == metrics(found, reading, STEPS)  # always in the map's view


@pytest.mark.parametrize("method", readings.MATCHERS)
def test_matchers_answer_in_the_readings_view(method):
    # Matchers take no disparities beyond the image; 32 of them in 110 columns.
    reading = replace(readings.matcher(readings.NEST_357, method), candidates=32)
    found = compute(Cell("cones", reading, None, "float"), scene("cones"))
    truth = scene("cones").truths["right"]
    seen = found.valid & truth.known
    assert seen.mean() > 0.1
    error = np.abs(found.disparity - truth.disparity)[seen]
    assert np.median(error) < 1
    assert f"blockSize={matchers.PARAMETERS[method]['blockSize']}" in matchers.parameters_text(method)


def test_lanes_stay_within_the_multipliers():
    for operator in ("mean", "prod", "soft_min_1"):
        config = readings.NEST_357.config(operator, lanes=64)
        assert config.multipliers <= readings.MULTIPLIERS
        wider = 2 * config.lanes
        if wider <= 64:
            data = {**config.model_dump(mode="json"), "lanes": wider, "max_multipliers": 10**6}
            assert type(config).from_dict(data).multipliers > readings.MULTIPLIERS
    assert readings.SAD.config().disparities % readings.SAD.config().lanes == 0
