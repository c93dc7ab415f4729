"""Every stream of the data path leaves a queue whose offers are proven to stand until they are taken."""

from collections.abc import Callable
from typing import Any

import pytest
from amaranth.hdl import Fragment, Value
from amaranth.lib.wiring import Component

from softdepth.hdl.core import StereoCore
from softdepth.hdl.front.front import Front
from softdepth.hdl.memory.item_queue import ItemQueue
from softdepth.hdl.memory.packed_queue import PackedQueue
from softdepth.hdl.memory.result_queue import ResultQueue
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from softdepth.hdl.post.masked_medians import MaskedMedians
from softdepth.hdl.post.median import Median
from softdepth.hdl.rooms import front_of
from softdepth.spec.config import Config
from tests.support.behind_queue import BehindQueue
from tests.support.claims import Claim
from tests.support.proofs import SAID

pytestmark = pytest.mark.formal

PROVEN = (ItemQueue, ResultQueue)
"""Of these `tests/hdl/test_proofs.py` proves it, whatever enters them."""


def queue_of(dut: Component) -> type | None:
    """The kind of proven queue whose ``o`` a block passes on, through blocks within it; None past logic."""
    fragment: Any = Fragment.get(dut, None)
    plain: list[Any] = [each for each in fragment.statements.get("comb", []) if hasattr(each, "lhs")]
    wired = {id(each.lhs): each.rhs for each in plain}
    sources = []
    for name in ("valid", "payload"):
        entering = wired.get(id(Value.cast(getattr(dut.o, name))))
        found = [
            block
            for block, *_ in (part.origins for part, *_ in fragment.subfragments if part.origins)
            if hasattr(block, "o")
            and hasattr(block.o, name)
            and Value.cast(getattr(block.o, name)) is entering
        ]
        sources.append(found[0] if found else None)
    source: Any = sources[0]
    if source is None or source is not sources[1]:
        return None
    return type(source) if isinstance(source, PROVEN) else queue_of(source)


ENDS = Claim(
    "what the input, the descriptors, the winners and every stage of `post` offer stays unchanged until it is"
    " taken: their streams are wired straight from one of these queues",
    sizes="small",
    depth="structure",
)


SMALL = ("max_width=32", "disparities=4", "lanes=2")


def winners(preset: str) -> Component:
    """The winners within a core."""
    core: Any = Fragment.get(StereoCore(Config.preset(preset).override(SMALL)), None)
    return next(part.origins[0] for part, name, *_ in core.subfragments if name == "winners")


BLOCKS: dict[str, tuple[Callable[[], Component], type]] = {
    "front": (lambda: Front(Config.preset("sad").override(SMALL)), ItemQueue),
    "descriptors": (lambda: front_of(Config.preset("robust").override(SMALL)), ResultQueue),
    "winners": (lambda: winners("robust"), ResultQueue),
    "winners with a border band": (lambda: winners("sad"), ResultQueue),
    "island": (lambda: Island(1, 1, 8, 5, rows=2, columns=2), ResultQueue),
    "fill": (lambda: Fill(1, 1, 8), ItemQueue),
    "packed queue": (lambda: PackedQueue(4, 40), ResultQueue),
    "median": (lambda: Median(1, 1, 8, rows=2, columns=2), ResultQueue),
    "masked medians": (lambda: MaskedMedians(1, 3, 3, 8, rows=2, columns=2, like=1), ResultQueue),
}


@ENDS.proven
@pytest.mark.parametrize("name", BLOCKS)
def test_a_stream_leaves_a_proven_queue(name: str) -> None:
    block, kind = BLOCKS[name]
    SAID.append("structure")
    assert queue_of(block()) is kind


class Withdrawing(BehindQueue):
    """One whose offer is taken back when another item arrives."""

    def given(self, queue: ItemQueue) -> list:
        return [self.o.valid.eq(queue.o.valid & ~self.i.valid), self.o.payload.eq(queue.o.payload)]


class Mixing(BehindQueue):
    """One whose word depends on what arrives."""

    def given(self, queue: ItemQueue) -> list:
        return [self.o.valid.eq(queue.o.valid), self.o.payload.eq(queue.o.payload ^ self.i.payload)]


@ENDS.refuted
@pytest.mark.parametrize(
    "block",
    [pytest.param(Withdrawing, id="an offer is taken back"), pytest.param(Mixing, id="a word changes")],
)
def test_logic_behind_a_queue_is_found(block: type[Component]) -> None:
    SAID.append("structure")
    assert queue_of(block()) is None
