"""Which candidates the compensating rule looks at."""

from amaranth.hdl import Module, Signal, Value

from softdepth.hdl.front.right_columns import candidate
from softdepth.spec.config import Config


def near_lanes(m: Module, config: Config, step: Value) -> list[Signal]:
    """For each lane, one clock after ``step``: whether the compensating rule's bound is reached."""
    near = []
    bound = config.compensation.from_disparity - config.min_disparity
    for lane in range(config.lanes):
        near.append(Signal(name=f"near_{lane}", reset_less=True))
        # The step's candidate is `farthest - step`.
        farthest = candidate(config, lane, 0)
        m.d.sync += near[lane].eq(step + bound <= farthest)
    return near
