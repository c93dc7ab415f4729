"""Which pixels lie in the border band."""

from amaranth.hdl import Const, Module, Value

from softdepth.hdl.costs.comparison import Plan
from softdepth.hdl.front.slots import Slots
from softdepth.hdl.memory.delay import Delay
from softdepth.spec.config import Config


def in_border(m: Module, config: Config, plan: Plan, slots: Slots) -> Value:
    """Whether the pixel judged by a slot lies in the border band, during the slot's clocks."""
    slot = slots.slot
    if config.whole_frame:
        return Const(0, 1)
    # The farthest of the rows and columns that it sees: the slot's own pixel is ``below`` rows below it, and
    # ``right`` columns beside it.
    low, high = slot.rows[plan.below - config.reach_rows], slot.rows[plan.below + config.reach_rows]
    m.submodules.seen = seen = Delay(1, plan.right - config.reach_right)
    m.d.comb += [seen.en.eq(slots.last), seen.i.eq(slot.inside)]
    return ~(low & high & seen.o & (slot.x >= plan.right + config.reach_left))
