"""What the tests of the studies of area and speed share: the fixtures of the flow's, and runs of nextpnr."""

from types import SimpleNamespace

import pytest

from softdepth.flow.synthesis import TOP
from softdepth.studies import utilization
from tests.flow.conftest import cache, path, refused
from tests.studies.rows import routed

__all__ = ["cache", "path", "refused", "runs"]


class Runs(list[int]):
    """The seeds of the runs of nextpnr, and what stands for the gateware."""

    gateware = "as it is"


@pytest.fixture
def runs(cache, monkeypatch):
    """Measurements that take no time: the netlists that were placed and routed, with their seeds.

    ``runs.gateware`` is what synthesis makes of every configuration.
    """
    done = Runs()

    def synthesise(design, family, folder, *, options):
        (folder / "netlist.json").write_text(f"{done.gateware} {design.config.hash}")
        return {"modules": {TOP: {"cells": {}}}}

    def place_and_route(folder, part, *, mhz, seed):
        done.append(seed)
        return routed()

    monkeypatch.setattr(
        utilization,
        "MeasuringTop",
        lambda config: SimpleNamespace(config=config, lut4=75, flip_flops=205),
    )
    monkeypatch.setattr(utilization, "synthesise", synthesise)
    monkeypatch.setattr(utilization, "place_and_route", place_and_route)
    return done
