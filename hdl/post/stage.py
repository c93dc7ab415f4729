"""What every stage behind the winners states of itself."""

from dataclasses import dataclass

from amaranth.lib import wiring

from softdepth.hdl.memory.result_queue import QUEUE_LATENCY
from softdepth.hdl.memory.window import Window


@dataclass(frozen=True)
class StageTime:
    """How long results are in a stage, and how long it takes for a frame.

    Members
    -------
    behind : clocks from the result that a line's last one needs to that one, where results come slowly.
    rows, columns : by how many lines a frame, and by how many results a line, takes longer.
    clocks : of a result, at least.
    """

    behind: int
    rows: int = 0
    columns: int = 0
    clocks: int = 1

    @classmethod
    def of_window(cls, rows: int, columns: int, clocks: int, latency: int) -> "StageTime":
        """Of a stage with a `Window` of this reach, ``latency`` clocks after which there are results."""
        behind = columns * clocks + Window.latency_of(clocks) + latency + QUEUE_LATENCY
        return cls(behind, rows, 2 * columns, clocks)

    def frame_clocks(self, width: int, height: int) -> int:
        """From a frame's first result to the next one's, at full rate."""
        return (width + self.columns) * (height + self.rows) * self.clocks


class PostStage(wiring.Component):
    """Takes a stream ``i`` of results and gives a stream ``o`` of as many.

    A core's latency and the time that it takes for a frame follow from `time`.
    """

    @property
    def time(self) -> StageTime:
        """How long this stage takes."""
        raise NotImplementedError
