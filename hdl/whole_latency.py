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
from softdepth.hdl.memory.window import Window
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from softdepth.hdl.post.stages import masked_medians_of, median_of
from softdepth.hdl.rooms import costs_of, drain_of, front_of
from softdepth.hdl.winners.argmin import ArgminSequence, ArgminTree, candidate_layout
from softdepth.hdl.winners.confidence import Confidence
from softdepth.hdl.winners.left_right import LeftRight
from softdepth.hdl.winners.neighbours import Neighbours
from softdepth.hdl.winners.number import number_latency
from softdepth.hdl.winners.sixteenths import Sixteenths
from softdepth.spec.config import Config
from softdepth.spec.post import MEDIAN_REACH


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
    right, below, drain : slots of ``steps`` clocks that the core takes more than a frame has pixels:
        beyond a line, lines below a frame, and behind it.
    ahead : columns and rows that descriptors look ahead, which a frame takes more, and ``below``.
    windows : rows and columns that the windows of the stages behind the winners reach: these take so many
        lines more a frame, and twice as many slots more a line.
    masked : rows and columns that the masked medians reach: they take so many lines more a frame, and slots
        more a line.
    """

    rows: int
    column: int
    clocks: int
    narrowest: int
    right: int
    below: int
    drain: int
    ahead: int
    windows: tuple[tuple[int, int], ...]
    masked: tuple[int, int]

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
            clocks = _up_to_winners(config, ahead) + _behind(config)
        return cls(
            rows=reach.below + post.below + ahead + 1,
            column=column,
            clocks=clocks,
            narrowest=max(config.disparities, column + 1, in_a_row + 1),
            right=reach.right,
            below=reach.below,
            drain=drain_of(config),
            ahead=ahead,
            windows=(
                *((post.island_reach,) if post.island else ()),
                *(((MEDIAN_REACH, MEDIAN_REACH),) if post.median else ()),
            ),
            masked=post.masked_reach,
        )

    def frame_clocks(self, width: int, height: int, steps: int) -> int:
        """From a frame's first pixel to the next one's, where pixels are always on offer.

        To within a line where a window behind the winners is the slowest, as it waits for what comes before.
        At most so many where candidates do not begin at 0, whose columns are dropped a clock each.
        """
        costs = ((width + self.right) * (height + self.below) + self.drain) * steps
        front = (width + 2 * self.ahead) * (height + self.ahead + self.below) * clocks_of(steps)
        windows = [(width + 2 * columns) * (height + rows) for rows, columns in self.windows]
        rows, columns = self.masked
        medians = (width + columns) * (height + rows) * min(steps, 2)
        return max(costs, front, medians, *(slots * clocks_of(steps) for slots in windows))


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


def _behind(config: Config) -> int:
    """Of the stages behind the winners: a window's last columns are its last one repeated."""
    post, folds = config.post, clocks_of(config.steps)

    def window(columns: int, latency: int) -> int:
        return columns * folds + Window.latency_of(folds) + latency + QUEUE_LATENCY

    clocks = max(-config.min_disparity, 0)  # border results that follow
    if post.island:
        clocks += window(post.island_reach[1], Island.latency)
    if post.fill:
        clocks += Fill.latency
    if post.median:
        clocks += window(MEDIAN_REACH, median_of(config).latency)
    if post.masked_median:
        clocks += masked_medians_of(config).latency + QUEUE_LATENCY
    return clocks
