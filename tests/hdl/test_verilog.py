"""Verilog: the documented ports, and refusal of what has no gateware."""

import gc
import re

import pytest

from softdepth import config as configuration
from softdepth.config import Config
from softdepth.errors import ConfigError
from softdepth.hdl.delay import Delay
from softdepth.hdl.operators import OPERATORS
from softdepth.hdl.verilog import TOP, to_verilog

from .support import config, sad


def ports(verilog: str, top: str) -> dict[str, tuple[str, int]]:
    """Direction and width of the top module's ports."""
    (body,) = re.findall(rf"^module {top}\(.*?^endmodule", verilog, re.DOTALL | re.MULTILINE)
    found = re.findall(r"^  (input|output) (?:\[(\d+):0\] )?(\w+) ?;", body, re.MULTILINE)
    return {name: (direction, int(high or 0) + 1) for direction, high, name in found}


@pytest.mark.parametrize(("disparities", "bits"), [(4, 2), (5, 3)])
def test_ports_are_as_documented(disparities: int, bits: int) -> None:
    c = config(cost="sad", criteria=[sad(3)], disparities=disparities, lanes=1)
    assert ports(to_verilog(c), TOP) == {
        "clk": ("input", 1),
        "rst": ("input", 1),
        "i__payload": ("input", 24 + 24 + 3),
        "i__valid": ("input", 1),
        "i__ready": ("output", 1),
        "o__payload": ("output", bits + 2 + 4),
        "o__valid": ("output", 1),
        "o__ready": ("input", 1),
        "status": ("output", 4 * 16),
    }


def test_any_component_by_any_name() -> None:
    text = to_verilog(Delay(3, 2), name="late")
    assert ports(text, "late") == {
        "clk": ("input", 1),
        "rst": ("input", 1),
        "en": ("input", 1),
        "i": ("input", 3),
        "o": ("output", 3),
    }


def test_text_depends_on_the_configuration_only() -> None:
    c = config(cost="sad", criteria=[sad(3)], disparities=4, lanes=2)
    assert to_verilog(c) == to_verilog(Config.from_dict(c.model_dump(mode="json")))


@pytest.mark.parametrize("preset", ["paper", "lite"])
@pytest.mark.parametrize("operator", [n for n in configuration.OPERATORS if n not in OPERATORS])
def test_an_operator_without_gateware_is_refused(
    operator: str, preset: str, recwarn: pytest.WarningsRecorder
) -> None:
    c = Config.preset(preset).override([f"operator={operator}"])

    def refusal() -> str:
        try:
            to_verilog(c)
        except ConfigError as error:
            return str(error)
        return "none"

    assert f"'{operator}' has no gateware" in refusal()
    gc.collect()  # half-built blocks would make Amaranth complain to the user as they go
    assert not [str(w.message) for w in recwarn]


def test_plain_sad_has_no_operator_to_refuse() -> None:
    c = config(cost="sad", criteria=[sad(3)], disparities=4, lanes=2, operator="prod")
    assert TOP in to_verilog(c)
