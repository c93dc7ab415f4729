"""Which rows of a frame complete the support of a result."""

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out


class SupportRows(wiring.Component):
    """Counts a frame's rows, up to the first whose pixels complete a support inside the image.

    Parameters
    ----------
    reach : rows that the support extends above, and below, its pixel.

    Members
    -------
    line_ends : the running row ends in this clock.
    frame_ends : the frame ends; wins over ``line_ends``.
    rows : complete rows of the frame, at most ``2 * reach``.
    first : the running row completes the support of the frame's first row.
    inner : the running row completes a support that lies inside the image.
    """

    def __init__(self, reach: int) -> None:
        self._reach = reach
        super().__init__(
            {
                "line_ends": In(1),
                "frame_ends": In(1),
                "rows": Out(range(2 * reach + 1)),
                "first": Out(1),
                "inner": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # The outputs about a row are known a row ahead.
        with m.If(self.line_ends & ~self.inner):
            m.d.sync += [
                self.rows.eq(self.rows + 1),
                self.first.eq(self.rows == self._reach - 1),
                self.inner.eq(self.rows == 2 * self._reach - 1),
            ]
        with m.If(self.frame_ends):
            m.d.sync += [self.rows.eq(0), self.first.eq(0), self.inner.eq(0)]
        return m
