"""The operator and the criterion of the tutorial, as it prints them: in models, gateware and export."""

import re
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from softdepth.cli.info import facts
from softdepth.golden import fixed_model, float_model
from softdepth.golden.costs.criteria import EVALUATE
from softdepth.golden.costs.fuzzy.fixed_operators import FIXED
from softdepth.golden.costs.fuzzy.operators import FLOAT
from softdepth.hdl.built import check_built, missing
from softdepth.hdl.core import StereoCore
from softdepth.hdl.costs import lane
from softdepth.hdl.costs.fuzzy.operators import CELL_OPERATORS, OPERATORS
from softdepth.sim.transfers import pack_frame
from softdepth.sources import sources_hash
from softdepth.spec import criteria, operators
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError
from softdepth.spec.registry import VARIABLE, Registry
from softdepth.studies.compare.document import exhaustive
from tests.cli.conftest import softdepth
from tests.hdl.test_core import check, images
from tests.support.simulation import sad, stream_through

__all__ = ["softdepth"]

REGISTRIES: tuple[Registry[Any], ...] = (
    criteria.CRITERIA,
    operators.REGISTRY,
    EVALUATE,
    FIXED,
    FLOAT,
    OPERATORS,
    CELL_OPERATORS,
    lane.CRITERIA,
)
PAGE = Path(__file__).resolve().parents[2] / "docs" / "extending.md"


@pytest.fixture(autouse=True)
def toys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The tutorial's code is known within a test, and unknown to all others of this process."""
    names = write_files(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv(VARIABLE, ",".join(names))
    with ExitStack() as scopes:
        for registry in REGISTRIES:
            scopes.enter_context(registry.scope())
        yield
    for name in names:
        sys.modules.pop(name, None)


def write_files(folder: Path) -> list[str]:
    """Write the tutorial's files into `folder`, as they stand on its page; gives the names of its modules."""
    blocks = re.findall(
        r'^```python title="(\w+)\.py"\n(.*?)^```', PAGE.read_text(), re.DOTALL | re.MULTILINE
    )
    for name, code in blocks:
        (folder / f"{name}.py").write_text(code)
    core = re.search(r"^```toml\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    assert core
    (folder / "toy.toml").write_text(core[1])
    return [name for name, _ in blocks]


def core(**keys: object) -> Config:
    criteria = [sad(3, 1, 11), {"kind": "spot"}, sad(5, 0, 12)]
    sizes = {"disparities": 6, "lanes": 2, "max_width": 64}
    return Config.from_dict({"criteria": criteria, "membership_bits": 8, **sizes, **keys})


FIRST = [{"kind": "spot"}, sad(3, 1, 11), sad(5, 0, 12)]
TWICE = [{"kind": "spot"}, sad(5, 0, 12), {"kind": "spot", "label_bits": 9}]


@pytest.mark.parametrize(
    "keys",
    [
        {"operator": "any"},
        {"operator": "any", "stored_rows": 4},
        {"operator": "soft_min_1"},
        {"operator": "mean", "criteria": FIRST},
        {"operator": "mean", "stored_rows": 4, "criteria": TWICE},
    ],
    ids=str,
)
def test_models_and_gateware(keys: dict[str, Any]) -> None:
    c = core(**keys)
    # Shifted beyond all candidates: none is right, and every criterion has its say.
    pairs = [images(3, c.min_width + 20, c.min_height + 3, 9), images(4, c.min_width + 9, c.min_height, 1)]
    payloads = list(chain.from_iterable(pack_frame(*pair).tolist() for pair in pairs))
    expected = [fixed_model.disparity(*pair, c) for pair in pairs]
    check(stream_through(StereoCore(c), payloads).payloads, expected)
    assert len(np.unique(expected[0].disparity)) > 2
    alike = float_model.disparity(*pairs[0], c, label=4096.0)
    assert (alike.code == expected[0].code).all()
    for i, criterion in enumerate(c.criteria):
        if criterion.kind == "spot":  # a core without it, as by a label too high for it, would not pass
            deaf = fixed_model.disparity(*pairs[0], c.override([f"criteria.{i}.label_bits=20"]))
            assert (deaf.disparity != expected[0].disparity).sum() > 3


def test_ranges_are_walked_and_never_left() -> None:
    c = core(operator="any", membership_bits=4)
    assert c.strength_range == (0, c.one)
    steps = np.arange(2 * c.one + 1, dtype=np.int32)
    inputs = [
        v.ravel() << s.label_bits - 4 for v, s in zip(np.meshgrid(*[steps] * 3), c.criteria, strict=True)
    ]
    n, s = fixed_model.fraction(c, 0, inputs)
    (n_low, n_high), (s_low, s_high) = c.cost_range
    assert n_low <= n.min() <= n.max() <= n_high
    assert 0 < s_low <= s.min() <= s.max() <= s_high


def test_without_gateware_of_the_cell_it_is_refused() -> None:
    with pytest.raises(ConfigError, match="no gateware of operator 'any' with firing = 'cell'"):
        StereoCore(core(operator="any", firing="cell"))


def test_a_kind_without_gateware_is_refused() -> None:
    assert "spot" in lane.CRITERIA
    without = lane.CRITERIA.scope(without={"spot"})
    with without, pytest.raises(ConfigError, match=r"'custom' has no gateware: criteria\.1 of kind 'spot';"):
        check_built(core())


def test_a_kind_without_a_band_has_a_model_only(monkeypatch: pytest.MonkeyPatch) -> None:
    spot = type(core().criteria[1])
    monkeypatch.setattr(spot, "whole_frame", True)
    assert not missing(core())
    needs = "criteria.1 of kind 'spot' where others, or what is behind the winners, need sums down columns"
    assert missing(core(post={"fill": True})) == (needs,)
    alone = {"cost": "sum", "criteria": [{"kind": "census"}, {"kind": "spot"}]}
    with lane.CRITERIA.scope(without={"spot"}):
        assert missing(core(**alone)) == ("criteria.1 of kind 'spot'",)
        told = facts(core(**alone), 100.0, 64, 48)
    assert told["gateware"] == "none of criteria.1 of kind 'spot': models alone"
    assert told["latency"].startswith("7 rows below")
    assert "gateware" not in facts(Config.preset("robust"), 100.0, 64, 48)


def test_what_is_kept_depends_on_the_extensions(monkeypatch: pytest.MonkeyPatch) -> None:
    with_toys = sources_hash("golden")
    monkeypatch.setenv(VARIABLE, "")
    assert sources_hash("golden") != with_toys


def test_export_info_and_documents(softdepth, tmp_path) -> None:
    """The core that the page prints is the one that is exported here."""
    printed = Config.load(tmp_path / "toy.toml")
    assert [c.kind for c in printed.criteria] == ["sad", "spot", "sad"]
    named = re.search(rf"{VARIABLE}=(\S+)", PAGE.read_text())
    assert named
    assert named[1].split(",") == write_files(tmp_path)
    outcome = softdepth("export", "--config", tmp_path / "toy.toml", "-o", tmp_path / "toy.v")
    assert outcome.code == 0, outcome.err
    assert "_lane_0_spot(" in (tmp_path / "toy.v").read_text()
    assert "| `any` | 0.00000 (0.00) |" in exhaustive()
