"""The right winner: the candidate of least cost for every pixel of the other view.

At candidate d, pixel x of the right view is matched with pixel x + d of the left. Pixels beyond the end of
the row are not candidates. On a tie the smallest d wins.
"""

from softdepth.golden.winners.left_winner import LeftWinner


class RightWinner(LeftWinner):
    """Like `LeftWinner`, for the pixels of the right view."""

    def columns(self, d: int) -> slice:
        """The columns of the partners of the reference view's columns from d on."""
        return slice(0, self.winner.shape[1] - d)
