"""No output of a stream listens to its own ``ready`` with logic alone between: no loop can close outside."""

import json
from collections import defaultdict
from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import Module
from amaranth.lib import stream
from amaranth.lib.wiring import Component, In, Out

from softdepth.flow.tools import find_tool
from softdepth.hdl.core import StereoCore
from softdepth.hdl.front.item_queue import ItemQueue
from softdepth.hdl.text.rtlil import to_rtlil
from softdepth.spec.config import Config
from tests.support.simulation import sad

CLOCKED = ("dff", "sdff", "adff", "dffe", "sdffe", "sdffce", "adffe", "aldff", "dffsr", "memwr_v2")


def listeners(dut: Component, folder: Path, source: str) -> set[str]:
    """The output ports that a port reaches through logic alone, as yosys knows the flattened block."""
    (folder / "dut.il").write_text(to_rtlil(dut, "dut"))
    script = "read_rtlil dut.il; hierarchy -top dut; proc; flatten; opt_clean; write_json dut.json"
    find_tool("yosys").run(["-q", "-l", "log", "-p", script], folder, log="log")
    module = json.loads((folder / "dut.json").read_text())["modules"]["dut"]
    leads: dict[Any, set[Any]] = defaultdict(set)
    for cell in module["cells"].values():
        if _clocked(cell):
            continue
        ways = cell["port_directions"]
        ends = [bit for name, bits in cell["connections"].items() if ways[name] == "output" for bit in bits]
        for name, bits in cell["connections"].items():
            if ways[name] == "input":
                for bit in bits:
                    leads[bit].update(ends)
    reached, coming = set(), list(module["ports"][source]["bits"])
    while coming:
        bit = coming.pop()
        if bit not in reached:
            reached.add(bit)
            coming += leads[bit]
    ports = module["ports"].items()
    return {name for name, p in ports if p["direction"] == "output" and reached & set(p["bits"])}


def _clocked(cell: dict[str, Any]) -> bool:
    """Whether the outputs of a cell of yosys change with a clock only."""
    kind = cell["type"].lstrip("$")
    return kind in CLOCKED or (kind == "memrd_v2" and int(cell["parameters"]["CLK_ENABLE"], 2) == 1)


class Waiting(Component):
    """A queue's output that is offered only where it is taken at once."""

    i: In(stream.Signature(2))
    o: Out(stream.Signature(2))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.queue = queue = ItemQueue(2)
        m.d.comb += [
            queue.i.valid.eq(self.i.valid),
            queue.i.payload.eq(self.i.payload),
            self.i.ready.eq(queue.i.ready),
            self.o.valid.eq(queue.o.valid & self.o.ready),
            self.o.payload.eq(queue.o.payload),
            queue.o.ready.eq(self.o.ready),
        ]
        return m


CORES = {
    "band": {"disparities": 4, "lanes": 2, "criteria": [sad(3)], "cost": "sum"},
    "whole frame": {
        "disparities": 4,
        "lanes": 2,
        "cost": "sum",
        "criteria": [{"kind": "census", "rows": 3, "taps": 3, "spacing": 1}],
    },
}


@pytest.mark.parametrize("name", CORES)
def test_no_output_of_a_core_listens_to_ready(name: str, tmp_path: Path) -> None:
    c = Config.from_dict({"max_width": 32, "max_height": 32, **CORES[name]})
    assert not listeners(StereoCore(c), tmp_path, "o_ready")


def test_an_offer_that_waits_for_ready_is_found(tmp_path: Path) -> None:
    assert listeners(Waiting(), tmp_path, "o_ready") == {"o_valid"}
    assert not listeners(ItemQueue(2), tmp_path, "o_ready")
