"""The sweep: every format once, each compared with the right float model."""

import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.run.report import Accuracy, accuracy
from softdepth.spec.config import OPERATORS, Config
from softdepth.spec.errors import ConfigError
from softdepth.studies.compare import sweep as sweeping
from softdepth.studies.compare.agreement import agreement
from softdepth.studies.compare.sweep import TOLERANCE, Label, Point, Sweep, enough, formats, sweep
from tests.studies.compare.conftest import point


@pytest.fixture
def small(monkeypatch):
    """A sweep of 2 x 3 formats, one of which no label holds."""
    monkeypatch.setattr(sweeping, "MEMBERSHIP_BITS", range(4, 7))
    monkeypatch.setattr(sweeping, "LABEL_BITS", (5, 10))


def test_every_format_that_fits_is_there(config):
    found = {(c.membership_bits, c.criteria[0].label_bits) for c in formats(config)}
    assert found == {(m, t) for m in range(4, 13) for t in range(9, 15) if m <= t}
    for choice in formats(config):
        assert len({criterion.label_bits for criterion in choice.criteria}) == 1
        assert [c.window for c in choice.criteria] == [3, 5, 7]
        assert (choice.operator, choice.disparities) == (config.operator, config.disparities)


@pytest.mark.parametrize("operator", OPERATORS)
def test_every_operator_can_be_swept(operator):
    assert formats(Config.preset("paper").override([f"operator={operator}", "lanes=1"]))


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize("operator", ["mean", "soft_min_1"])
def test_points_are_what_the_models_give(config, pair, operator):
    config = config.override([f"operator={operator}", "compensation.reading=top"])
    paper = float_model.disparity(pair.left, pair.right, config)
    found = sweep(pair, config, paper)
    assert [(p.membership_bits, p.label_bits) for p in found.points] == [
        (4, 5),
        (5, 5),
        (4, 10),
        (5, 10),
        (6, 10),
    ]
    for each in found.points:
        labels = [f"criteria.{i}.label_bits={each.label_bits}" for i in range(3)]
        choice = config.override([f"membership_bits={each.membership_bits}", *labels])
        fixed = fixed_model.disparity(pair.left, pair.right, choice)
        same = float_model.disparity(pair.left, pair.right, config, label=2**each.label_bits)
        assert each.to_float == agreement(fixed, paper, pair.truth)
        assert each.to_same_label == agreement(fixed, same, pair.truth)
        assert each.accuracy == accuracy(fixed, pair.truth)
        label = next(entry for entry in found.labels if entry.label_bits == each.label_bits)
        assert label.to_float == agreement(same, paper, pair.truth)
        assert label.accuracy == accuracy(same, pair.truth)


@pytest.mark.parametrize("operator", ["mean", "min"])
def test_nothing_is_lost_where_no_bit_is_dropped(config, pair, operator):
    config = config.override([f"operator={operator}"])
    found = sweep(pair, config, float_model.disparity(pair.left, pair.right, config))
    for bits in (10, 11, 12):
        assert point(found, bits, bits).to_same_label.differ == 0
        assert point(found, 4, bits).to_same_label.differ > 0


@pytest.mark.usefixtures("small")
def test_without_truth_nothing_is_scored(config, pair):
    blind = type(pair)(pair.left, pair.right, pair.name)
    found = sweep(blind, config, float_model.disparity(pair.left, pair.right, config))
    assert {label.enough for label in found.labels} == {None}
    assert {point.accuracy.bad1 for point in found.points} == {None}
    assert all(point.to_float.closer is None for point in found.points)


def points(*bad1: float) -> Sweep:
    same = agreement_of_nothing()
    return Sweep(
        labels=[Label(label_bits=10, to_float=same, accuracy=Accuracy())],
        points=[
            Point(
                membership_bits=bits,
                label_bits=10,
                to_float=same,
                to_same_label=same,
                accuracy=Accuracy(bad1=value),
            )
            for bits, value in enumerate(bad1, start=4)
        ],
    )


def agreement_of_nothing():
    from softdepth.studies.compare.agreement import Agreement

    return Agreement(pixels=1, differ=0, differ1=0, differ2=0, mae=0, rmse=0)


def test_enough_is_where_it_stays_good():
    assert enough(points(30, 22, 20.5, 20, 20), 10, 20) == 6
    assert enough(points(20, 30, 20, 20), 10, 20) == 6, "a lucky narrow format is not enough"
    assert enough(points(20, 20, 20 + TOLERANCE + 0.01), 10, 20) is None
    assert enough(points(20, 20), 10, None) is None


def test_a_configuration_without_memberships_is_refused():
    with pytest.raises(ConfigError, match="cost is 'sum'"):
        sweeping.check_sweepable(Config.preset("sad"))
