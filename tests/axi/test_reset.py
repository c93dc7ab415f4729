"""Resets of the whole core at random clocks in mid-frame: what follows is as if nothing had been before."""

from pathlib import Path
from random import Random

import numpy as np
import pytest

from softdepth.hdl.axi import core as core_module
from softdepth.hdl.axi.core import AxiCore
from softdepth.hdl.axi.frames import Frames
from softdepth.hdl.axi.register_bank import RegisterBank
from softdepth.hdl.verilog import TOP, to_verilog
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from softdepth.spec.registers import registers
from tests.axi.runs import PAPER, ROBUST, Design, Steps, built, expected, run
from tests.cocotb.scenes import textured
from tests.support.mutations import mutated

SIZE = ["max_width=24", "max_height=12", "disparities=4", "lanes=2"]
SAD = Design(Config.preset("sad").override(SIZE), AxiOptions(left=True))
LITE = Design(Config.preset("lite").override(SIZE))
RESETS = 20
CLOCKS = 1200
"""Less than these, and some of them after the first results."""
pytestmark = pytest.mark.slow


def after_reset(design: Design) -> dict[str, int]:
    """What the description says of each register."""
    described = registers(design.config, design.options)
    return {r.name: sum(f.reset << f.low for f in r.fields if not f.pulses) for r in described}


def check(design: Design, folder: Path, *, core: Path | None = None) -> None:
    """Video and writes that are cut short, registers at their reset values, then frames, which are exact."""
    random = Random(7)
    config, options = design.config, design.options
    cut = Steps(design)
    for number in range(3):
        left, right = textured(config.max_height - number, config.max_width - number, number)
        cut.lines(left, right, range(left.shape[0]))
    for register in registers(config, options):
        if any(f.writable for f in register.fields):
            cut.write(register.name, random.getrandbits(32))
    steps, wanted = Steps(design), []
    steps.write("INTERRUPTS", 1)
    for number, (height, width) in enumerate([(7, config.min_width), (9, config.max_width)]):
        left, right = textured(height, width, 10 + number)
        steps.lines(left, right, range(height))
        wanted.append(expected(left, right, config, pixels=options.left))
    steps.lines(*textured(2, config.min_width, 99), range(2))
    resets = [random.randrange(1, CLOCKS) for _ in range(RESETS)]
    out = run(steps, folder, seed=4, idle=0.1, pressure=0.2, resets=resets, cut=cut, core=core)
    for clocks, found in zip(resets, out.after_resets, strict=True):
        assert found == after_reset(design), f"after {clocks} clocks"
    for got, want in zip(out.frames, wanted, strict=False):
        assert np.array_equal(got, want)
    assert len(out.frames) >= len(wanted)
    assert out.registers["FRAMES"] == len(wanted)
    assert out.registers["FLAGS"] & 0b111110 == 0
    assert out.irq == 1


@pytest.mark.parametrize(
    "design",
    [
        pytest.param(SAD, id="sad"),
        pytest.param(LITE, id="lite", marks=pytest.mark.full),
        pytest.param(PAPER, id="paper, two streams"),
        pytest.param(ROBUST, id="robust-small"),
    ],
)
def test_frames_after_resets_at_random_clocks_are_exact(design: Design, tmp_path: Path) -> None:
    check(design, tmp_path)


@pytest.mark.full
@pytest.mark.parametrize(
    ("block", "old"),
    [
        (Frames, "inside = Signal(range(self._most + 1)"),
        (RegisterBank, "init=reset"),
    ],
)
def test_what_is_not_reset_is_found(
    block: type, old: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Frames that were inside, for which the settings that are written then wait; registers."""
    monkeypatch.setattr(core_module, block.__name__, mutated(block, old, f"{old}, reset_less=True"))
    broken = built(SAD, to_verilog(AxiCore(SAD.config, SAD.options), TOP))
    with pytest.raises(AssertionError):
        check(SAD, tmp_path, core=broken)
