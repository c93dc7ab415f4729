"""What a lane takes without a saving, on a lane that is quickly built."""

import json

import pytest

from softdepth.spec.config import Config
from softdepth.studies.savings import DOCUMENT, FIGURES, ROW_MEMORY, VARIANTS, measure, operator_page

LANE = Config.preset("sad").override(["disparities=4", "lanes=2", "max_width=1280"])
"""As many places as its row memory has in a core of 64 candidates and 32 lanes."""


@pytest.mark.slow
def test_each_saving_saves():
    found = {v.without: measure(LANE, v) for v in VARIANTS if "sad" in v.presets}
    as_it_is, *others = found.values()
    for without, lane in list(found.items())[1:]:
        assert lane["lut4"] > as_it_is["lut4"] or lane["ff"] > as_it_is["ff"], without
    assert found[ROW_MEMORY]["ebr"] == 0 < as_it_is["ebr"]
    assert found["any of these"]["lut4"] == max(lane["lut4"] for lane in others)


def test_operators_are_set_beside_mean():
    lane = {"ff": 5, "ebr": 0, "dsp": 2}
    over_all = {"min": {**lane, "lut4": 150}, "mean": {**lane, "lut4": 100}}
    table = operator_page({"all": over_all, "cell": {"mean": {**lane, "lut4": 60}}}).splitlines()
    assert table[2:] == [
        "| min | all | 150 | 1.50 | 5 | 2 |",
        "| mean | all | 100 | 1.00 | 5 | 2 |",
        "| mean | cell | 60 | 0.60 | 5 | 2 |",
    ]


def test_the_documents_table_of_operators_is_what_the_measurements_give(project):
    found = json.loads((project / FIGURES).read_text())
    table = operator_page({"all": found["lanes"], "cell": found["lanes_of_the_cell"]})
    assert f"-->\n{table}\n<!--" in (project / DOCUMENT).read_text()
