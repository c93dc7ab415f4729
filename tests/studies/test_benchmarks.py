"""The benchmarks: what is measured, and that the page says what the figures do."""

from types import SimpleNamespace

from softdepth.cli.bench import bench
from softdepth.golden.data.synthetic import generate
from softdepth.hdl.built import missing
from softdepth.spec.config import PRESETS, Config
from softdepth.studies import benchmarks


def test_the_page_holds_what_was_measured(monkeypatch):
    simulated = []

    def run_frames(config, frames, progress):
        simulated.append((config.name, frames[0][0].shape[:2], config.max_width))
        return SimpleNamespace(cycles_per_pixel=4.125, pixels_per_second=1234.5)

    monkeypatch.setattr(benchmarks, "run_frames", run_frames)
    pair = generate("random", width=48, height=32, disparities=8, seed=1)
    figures = benchmarks.measured(pair, 30, 2, ["sad", "robust-gray"], [1])
    assert simulated == [("sad", (30, 48), 48), ("robust-gray", (30, 48), 48)]
    assert figures["presets"]["robust-gray"]["fixed_seconds"] > 0
    assert figures["sequence"].keys() == {"preset", "frames", "seconds"}
    assert figures["sequence"]["seconds"]["1"] > 0
    figures["sequence"] = {"preset": "paper", "frames": 6, "seconds": {"1": 3.0, "2": 2.0}}
    page = benchmarks.page(figures)
    assert "| 2 | 2.0 | 3.00 | 1.50 |" in page
    assert "| sad | 64 | 16 | 4.125 | 1,234 |" in page


def test_every_preset_with_gateware_is_measured(monkeypatch, tmp_path):
    asked = []

    def measured(pair, rows, frames, presets):
        asked.append((pair.name, rows, frames, presets))
        return {}

    monkeypatch.setattr(benchmarks, "measured", measured)
    monkeypatch.setattr(benchmarks, "page", lambda figures: "page")
    bench("motorcycle", 40, 3, tmp_path)
    assert asked == [("motorcycle", 40, 3, [name for name in PRESETS if not missing(Config.preset(name))])]
    assert {"paper", "compact", "lite", "sad", "robust", "robust-gray", "robust-small"} <= set(asked[0][3])
    assert (tmp_path / "benchmarks.md").read_text() == "page"
