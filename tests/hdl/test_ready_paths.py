"""No output of a stream listens to its own ``ready`` with logic alone between: no loop can close outside."""

import json
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from amaranth.lib import data
from amaranth.lib.wiring import Component

from softdepth.flow.tools import find_tool
from softdepth.hdl.axi.core import AxiCore
from softdepth.hdl.core import StereoCore
from softdepth.hdl.front.frame_ends import FrameEnds
from softdepth.hdl.front.front import Front
from softdepth.hdl.memory.item_queue import ItemQueue
from softdepth.hdl.memory.result_queue import ResultQueue
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from softdepth.hdl.post.masked_medians import MaskedMedians
from softdepth.hdl.post.median import Median
from softdepth.hdl.rooms import front_of
from softdepth.hdl.text.rtlil import to_rtlil
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from tests.support.behind_queue import BehindQueue
from tests.support.claims import Claim
from tests.support.proofs import SAID
from tests.support.simulation import sad

pytestmark = pytest.mark.formal

CLOCKED = ("dff", "sdff", "adff", "dffe", "sdffe", "sdffce", "adffe", "aldff", "dffsr", "memwr_v2")


def listeners(dut: Component, folder: Path, source: str) -> set[str]:
    """The output ports that a port reaches through logic alone, as yosys knows the flattened block."""
    (folder / "dut.il").write_text(to_rtlil(dut, "dut"))
    SAID.append("structure")
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


class Waiting(BehindQueue):
    """A queue's output that is offered only where it is taken at once."""

    def given(self, queue: ItemQueue) -> list:
        return [self.o.valid.eq(queue.o.valid & self.o.ready), self.o.payload.eq(queue.o.payload)]


CORES = {
    "band": {"disparities": 4, "lanes": 2, "criteria": [sad(3)], "cost": "sum"},
    "whole frame": {
        "disparities": 4,
        "lanes": 2,
        "cost": "sum",
        "criteria": [{"kind": "census", "rows": 3, "taps": 3, "spacing": 1}],
    },
}


OUTPUTS = Claim(
    "no output of a core depends on its `o.ready` through logic alone, `i.ready` included; nor one of the"
    " core with"
    " AXI streams, of one stream in or two, on `m_axis_tready`",
    sizes="a small core with and one without a border band",
    depth="structure",
)
STAGES = Claim(
    "what a block offers does not depend on whether it is taken: the input, descriptors, frame ends, and"
    " every stage"
    " of `post`",
    sizes="small",
    depth="structure",
)


def small(name: str) -> Config:
    return Config.from_dict({"max_width": 32, "max_height": 32, **CORES[name]})


@OUTPUTS.proven
@pytest.mark.parametrize("name", CORES)
def test_no_output_of_a_core_listens_to_ready(name: str, tmp_path: Path) -> None:
    assert not listeners(StereoCore(small(name)), tmp_path, "o_ready")


@OUTPUTS.refuted
@pytest.mark.parametrize("block", [pytest.param(Waiting, id="an offer waits for ready")])
def test_an_offer_that_waits_for_ready_is_found(block: type[Component], tmp_path: Path) -> None:
    assert listeners(block(), tmp_path, "o_ready") == {"o_valid"}


@STAGES.refuted
@pytest.mark.parametrize("block", [pytest.param(Waiting, id="an offer waits for ready")])
def test_a_stage_that_waits_for_ready_is_found(block: type[Component], tmp_path: Path) -> None:
    assert not listeners(block(), tmp_path, "o_ready") <= {"i_ready"}


@pytest.mark.parametrize("places", [1, 2])
def test_a_queue_listens_to_no_ready(places: int, tmp_path: Path) -> None:
    assert not listeners(ItemQueue(2, places=places), tmp_path, "o_ready")


BLOCKS: dict[str, Callable[[], Component]] = {
    "frame ends": lambda: FrameEnds(small("whole frame")),
    "front": lambda: Front(small("band")),
    "descriptors": lambda: front_of(small("whole frame")),
    "island": lambda: Island(1, 1, 8, 5, rows=2, columns=2),
    "fill": lambda: Fill(1, 1, 8),
    "median": lambda: Median(1, 1, 8, rows=2, columns=2),
    "masked medians": lambda: MaskedMedians(1, 3, 3, 8, rows=2, columns=2, like=1),
    "result queue": lambda: ResultQueue(data.StructLayout({"word": 2}), 3),
}


@STAGES.proven
@pytest.mark.parametrize("name", BLOCKS)
def test_no_offer_of_a_block_listens_to_ready(name: str, tmp_path: Path) -> None:
    """Where a block is one register, its `i.ready` may listen; what it offers never does."""
    assert listeners(BLOCKS[name](), tmp_path, "o_ready") <= {"i_ready"}


@OUTPUTS.proven
@pytest.mark.parametrize("options", [AxiOptions(), AxiOptions("wishbone", inputs="two", left=True)])
def test_no_axi_output_listens_to_ready(options: AxiOptions, tmp_path: Path) -> None:
    assert not listeners(AxiCore(small("band"), options), tmp_path, "m_axis_tready")
