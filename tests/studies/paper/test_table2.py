"""The arithmetic of the table and its summary, on made-up figures."""

import pytest

from softdepth.spec.config import OPERATORS
from softdepth.studies.paper import published
from softdepth.studies.paper.table2 import Row, mean_deviation, summarise


def row(method, scene, operator, off, **more):
    printed = {"SAD": published.SAD, "[11]": published.PROTOTYPE, "FMCDM": published.FMCDM}.get(method)
    value = None if printed is None else printed[scene] if operator is None else printed[scene][operator]
    model = off if value is None else value + off
    fields = {"fixed": model, "rtl": None, "deviation": None if value is None else off, **more}
    return Row(
        scene=scene, method=method, operator=operator, reading="r", published=value, float=model, **fields
    )


@pytest.fixture
def rows():
    found = []
    for index, scene in enumerate(published.SCENES):
        found.append(row("SAD", scene, None, 0.1 * index))
        found += [row("[11]", scene, o, 2.0 if n % 2 else -4.0) for n, o in enumerate(OPERATORS)]
        found += [row("FMCDM", scene, o, -0.5) for o in OPERATORS]
    outlier = next(r for r in found if (r.method, r.scene, r.operator) == ("FMCDM", *published.OUTLIER))
    outlier.float = outlier.published + 6.5
    return found


PLAIN = [row(method, s, None, 50.0) for s in published.SCENES for method in ("SAD 3x3", "SAD 7x7")]


def summary(rows, plain=PLAIN, own=None):
    fmcdm = [r for r in rows if r.method == "FMCDM"]
    return summarise(rows, plain, {"r": fmcdm}, own or dict(published.SAD))


def test_deviations_are_means_of_absolute_values(rows):
    found = summary(rows)
    assert found.sad_max_deviation == pytest.approx(0.2)
    assert found.fmcdm_mean_deviation_14 == pytest.approx(0.5)
    assert found.fmcdm_mean_deviation_15 == pytest.approx((14 * 0.5 + 6.5) / 15)
    assert found.prototype_mean_deviation == pytest.approx((3 * 4 + 2 * 2) / 5)
    assert found.readings == {"r": found.fmcdm_mean_deviation_14}


def test_venus_prod_counts_in_no_mean_of_14(rows):
    fmcdm = [r for r in rows if r.method == "FMCDM"]
    before = mean_deviation(fmcdm)
    next(r for r in fmcdm if (r.scene, r.operator) == published.OUTLIER).float = 1000.0
    assert mean_deviation(fmcdm) == before
    next(r for r in fmcdm if (r.scene, r.operator) == ("venus", "mean")).float = 1000.0
    assert mean_deviation(fmcdm) > 60


def test_gains_are_means_over_the_scenes_in_per_cent(rows):
    for r in rows:
        r.published, r.float = {"SAD": (50.0, 40.0), "FMCDM": (30.0, 36.0)}.get(r.method, (1.0, 1.0))
    plain = [row(m, s, None, v) for s in published.SCENES for m, v in (("SAD 3x3", 48.0), ("SAD 7x7", 30.0))]
    found = summary(rows, plain)
    assert found.gain_published == pytest.approx(40)
    assert found.gain_two_views == pytest.approx(10)
    assert found.gain_one_view == pytest.approx(25)
    assert found.gain_over_wide_sad == pytest.approx(-20)


def test_fixed_is_compared_with_float_and_published(rows):
    cell = next(r for r in rows if (r.method, r.scene, r.operator) == ("FMCDM", "cones", "min"))
    cell.fixed = cell.float - 0.75
    found = summary(rows)
    assert found.fixed_float_max_difference == pytest.approx(7.0)  # the outlier, whose float alone moved
    assert found.fixed_mean_deviation_14 == pytest.approx((13 * 0.5 + 1.25) / 14)


def test_gateware_counts_what_ran(rows):
    assert (summary(rows).rtl_cells, summary(rows).rtl_mismatches) == (0, None)
    rows[0].rtl_mismatches, rows[8].rtl_mismatches = 0, 3
    assert (summary(rows).rtl_cells, summary(rows).rtl_mismatches) == (2, 3)


def test_sad_in_its_own_view(rows):
    own = {scene: value - 3.5 for scene, value in published.SAD.items()}
    assert summary(rows, own=own).sad_own_truth_max_deviation == pytest.approx(3.5)


def test_published_figures_are_complete():
    for table in (published.PROTOTYPE, published.FMCDM):
        assert tuple(table) == published.SCENES
        assert all(tuple(cells) == OPERATORS for cells in table.values())
    assert set(published.TITLES) == set(OPERATORS)
