"""When the results of a core with descriptors leave it: from which pixel, and how many clocks after."""

from dataclasses import dataclass

from softdepth.hdl.asked import asked
from softdepth.hdl.costs.comparison import plan
from softdepth.hdl.costs.layout import is_fraction
from softdepth.hdl.costs.whole_costs import WholeCosts
from softdepth.hdl.front.descriptors import descriptors_latency, window_reach
from softdepth.hdl.front.frame_ends import FrameEnds
from softdepth.hdl.front.front import Front
from softdepth.hdl.front.tall_window import TallWindow
from softdepth.hdl.memory.folded_memory import clocks_of
from softdepth.hdl.memory.result_queue import QUEUE_LATENCY
from softdepth.hdl.post.stage import StageTime
from softdepth.hdl.post.stages import post_stages
from softdepth.hdl.rooms import costs_of, drain_of, front_of
from softdepth.hdl.winners.argmin import ArgminSequence, ArgminTree, candidate_layout
from softdepth.hdl.winners.confidence import Confidence
from softdepth.hdl.winners.left_right import LeftRight
from softdepth.hdl.winners.neighbours import Neighbours
from softdepth.hdl.winners.number import number_latency
from softdepth.hdl.winners.sixteenths import Sixteenths
from softdepth.spec.config import Config


@dataclass(frozen=True)
class WholeLatency:
    """Of `config`'s core, for lines of at least ``narrowest`` pixels.

    Members
    -------
    rows, column : the last pixel that line y's results need is at (column, y + rows).
    clocks : from the clock in which that pixel is taken to that in which the line's last result can be,
        where pixels come slowly and that result is a measurement.
    narrowest : pixels of the shortest line of which that is so. A line's last results come in a row, and
        those of a shorter one would meet the repeats of its first in a stage's window.
    right, below, drain : extra slots of ``steps`` clocks: after each line, in lines below the frame, and
        after the frame.
    ahead : columns and rows that descriptors look ahead; a frame takes longer by this and by ``below``.
    stages : how long each stage behind the winners takes.
    """

    rows: int
    column: int
    clocks: int
    narrowest: int
    right: int
    below: int
    drain: int
    ahead: int
    stages: tuple[StageTime, ...]

    @classmethod
    def of(cls, config: Config) -> "WholeLatency":
        """Derived from what the core's blocks state."""
        reach, post = plan(config), config.post
        ahead = window_reach(reach.descriptors.values())
        late = abs(config.min_disparity)  # columns that come in before the first that the views share
        # A line's last pixel waits for the next to come, which may be the frame's end; the right view's
        # winners are known so many columns later, which are the next line's.
        column = config.disparities - 2 + ahead + late if post.check else 0
        # With the last pixel: repeats of its column, and what follows from windows that look ahead.
        in_a_row = 1 + post.island_reach[1] + (0 if post.check else ahead + reach.right)
        with asked():
            stages = tuple(stage.time for stage in post_stages(config).values())
            clocks = _up_to_winners(config, ahead) + sum(time.behind for time in stages)
        return cls(
            rows=reach.below + post.below + ahead + 1,
            column=column,
            clocks=clocks,
            narrowest=max(config.disparities, column + 1, in_a_row + 1),
            right=reach.right,
            below=reach.below,
            drain=drain_of(config),
            ahead=ahead,
            stages=stages,
        )

    def frame_clocks(self, width: int, height: int, steps: int) -> int:
        """From a frame's first pixel to the next one's, where pixels are always on offer.

        To within a line where a window behind the winners is the slowest, as it waits for what comes before.
        An upper bound where candidates do not begin at 0: a column that is dropped takes only a clock.
        """
        costs = ((width + self.right) * (height + self.below) + self.drain) * steps
        front = (width + 2 * self.ahead) * (height + self.ahead + self.below) * clocks_of(steps)
        return max(costs, front, *(time.frame_clocks(width, height) for time in self.stages))


def _up_to_winners(config: Config, ahead: int) -> int:
    steps, post = config.steps, config.post
    costs = costs_of(config, front_of(config).layout)
    assert isinstance(costs, WholeCosts)
    num, den = (costs.layout.members[name] for name in ("num", "den"))
    tree = ArgminTree(num, den, config.lanes)
    sequence = ArgminSequence(candidate_layout(num, den, config.disparities), steps)
    front = Front.to_descriptors
    described = TallWindow.latency_of(clocks_of(steps)) + descriptors_latency(
        plan(config).descriptors.values()
    )
    described += QUEUE_LATENCY + WholeCosts.waits
    judged = tree.latency + sequence.latency + steps
    judged += Neighbours(config.lanes, steps, costs.layout, runner_up=post.confidence).latency
    judged += number_latency(*config.number_range) if is_fraction(costs.layout) else 0
    judged += Sixteenths.latency if post.fraction_bits else Confidence.latency
    # Without a check a line's last slots follow each other, and `FrameEnds` lets its last pixel go in the
    # clock in which the pixel that follows comes.
    row = (ahead + plan(config).right) * steps - FrameEnds.latency
    checked = LeftRight.latency if post.check else row
    return front + described + costs.latency + steps - 1 + judged + checked + QUEUE_LATENCY
