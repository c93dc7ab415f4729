"""The README's figures come from a report, and only from a complete one."""

import json

import pytest

from softdepth.run.measure import Engine
from softdepth.run.report import ENGINES, Accuracy, Report
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.studies import readme
from softdepth.studies.markers import markers


@pytest.fixture
def report() -> Report:
    config = Config.preset("paper")
    scores: dict[Engine, Accuracy] = {
        e: Accuracy(bad1=1.5 + n, bad2=2.5, mae=3.5, rmse=4.5, paper_rmse=5.5) for n, e in enumerate(ENGINES)
    }
    return Report(
        engine="rtl",
        pair="motorcycle",
        width=741,
        height=500,
        pixels=370500,
        notes=[],
        rtl_mismatches=0,
        cycles_per_pixel=4.0,
        sim_pixels_per_second=1000.0,
        seconds=dict.fromkeys(ENGINES, 1.0),
        metrics=scores,
        config=config.model_dump(mode="json"),
        config_hash=config.hash,
        tools={},
    )


ROW = dict(
    device="LFE5U-85F-6", preset="paper", operator="mean", disparities=64, lanes=4, width=1280, lut4=4000,
    ff=5000, ebr=20, dsp=8, fmax_mhz=120.0, cycles_per_pixel=16, mpixel_s=7.5, mde_s=480.0,
    mde_s_per_klut=120.0, lut4_per_lane=1000.0,
)  # fmt: skip
"""A row of the table of area and speed."""

TEXT = f"above\n{readme.BEGIN}\nold 99.99 %\n{readme.END}\nbelow\n"


def test_figures_stand_between_the_markers(report):
    found = readme.renew(TEXT, report)
    assert found.startswith("above\n")
    assert found.endswith(f"{readme.END}\nbelow\n")
    assert "old" not in found
    assert "**0 of 370,500 pixels** differ" in found
    assert "| gateware (simulated) | 1.50 % | 2.50 % | 3.50 px | 4.50 px | 5.50 |" in found
    assert "| plain SAD 3x3 | 5.50 % |" in found
    assert readme.renew(found, report) == found


def test_markers_must_be_there(report):
    with pytest.raises(InputError, match="markers"):
        readme.renew("no markers", report)


def test_a_run_without_gateware_has_no_figures(report):
    with pytest.raises(InputError, match="no gateware"):
        readme.figures(report.model_copy(update={"rtl_mismatches": None}))


def test_main_needs_results(tmp_path):
    with pytest.raises(InputError, match="make demo"):
        readme.main(tmp_path, tmp_path)


def test_main_renews_text_and_picture(report, project, tmp_path):
    results, home = tmp_path / "results", tmp_path / "home"
    results.mkdir()
    home.mkdir()
    (results / "report.json").write_text(json.dumps(report.model_dump()))
    (results / "overview.png").write_bytes((project / readme.PICTURE).read_bytes())
    (home / "docs").mkdir()
    (home / readme.UTILIZATION).write_text(json.dumps({"rows": [ROW]}))
    first, last = markers(readme.AREA)
    area = f"{first}\nold\n{last}\n"
    (home / "README.md").write_text(TEXT + area)
    readme.main(results, home)
    found = (home / "README.md").read_text()
    assert found.startswith(readme.renew(TEXT, report))
    assert readme.area(json.dumps({"rows": [ROW]})) in found
    assert "old" not in found
    assert (home / readme.PICTURE).stat().st_size > 0


def test_the_projects_readme_shows_measured_figures(project):
    text = (project / "README.md").read_text()
    between = text.split(readme.BEGIN)[1].split(readme.END)[0]
    demo = Config.preset("robust").override(["max_width=741", "max_height=500"])  # as large as the pair
    assert demo.hash in between, "the preset changed: make readme"
    assert "**0 of 370,500 pixels** differ" in between


def test_the_area_is_that_of_the_fastest_core_of_each_preset_and_part():
    fast = {**ROW, "lanes": 32, "lut4": 31000, "mde_s": 3840.0, "mpixel_s": 60.0, "lut4_per_lane": 968.75}
    other = {**fast, "operator": "min", "mde_s": 9999.0}
    plain = {**ROW, "preset": "sad", "lut4": 900}
    smaller = {**plain, "device": "LFE5U-25F-6", "lut4": 800}
    table = readme.area(json.dumps({"rows": [ROW, fast, other, plain, smaller]})).splitlines()
    assert len(table) == 5
    assert table[2].startswith(
        "| `paper`, 64 disparities, 32 lanes, 1280 wide | LFE5U-85F-6 | 31,000 (969) |"
    )
    assert table[3].startswith("| `sad`")
    assert "| LFE5U-25F-6 | 800 (" in table[4]


def test_the_projects_table_of_cores_is_what_the_measurements_give(project):
    first, last = markers(readme.AREA)
    text = (project / "README.md").read_text().split(first)[1].split(last)[0]
    assert text.strip() == readme.area((project / readme.UTILIZATION).read_text())
