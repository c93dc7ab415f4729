"""Triangular memberships whose division is a shift (Bobyr et al. 2021, step 2, eq. 9)."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.spec.config import Config


def memberships_layout(config: Config) -> data.StructLayout:
    """The degrees of the labels low (``A1``), middle (``A2``) and high (``A3``); `Config.one` is 1.0."""
    degree = range(config.one + 1)
    return data.StructLayout({"low": degree, "middle": degree, "high": degree})


class Membership(wiring.Component):
    """Degrees of a criterion's three labels at 0, T and 2T; inputs saturate at 2T.

    ``low + middle + high`` is always `Config.one`. One value a clock, two clocks of latency.

    Parameters
    ----------
    config : the core's configuration.
    label_bits : ``T = 2**label_bits``.
    maximum : the largest value that the criterion takes.

    Members
    -------
    i : the criterion's value.
    o : its memberships.
    """

    latency = 2

    def __init__(self, config: Config, label_bits: int, maximum: int) -> None:
        self._config = config
        self._label_bits = label_bits
        super().__init__({"i": In(range(maximum + 1)), "o": Out(memberships_layout(config))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        one = self._config.one
        bits = self._config.membership_bits
        top = 2 << self._label_bits

        # Dissimilarity in units of 1 / one, 0 .. 2 * one.
        scaled = Signal(range(2 * one + 1), reset_less=True)
        saturated = self.i >= top
        m.d.sync += scaled.eq(Mux(saturated, 2 * one, self.i >> (self._label_bits - bits)))

        fraction = scaled[:bits]
        upper = scaled[bits]  # between T and 2T
        ceiling = scaled[bits + 1]  # at 2T
        rest = one - fraction
        degrees = Signal(memberships_layout(self._config), reset_less=True)
        m.d.sync += [
            degrees.low.eq(Mux(upper | ceiling, 0, rest)),
            degrees.middle.eq(Mux(ceiling, 0, Mux(upper, rest, fraction))),
            degrees.high.eq(Mux(ceiling, one, Mux(upper, fraction, 0))),
        ]
        m.d.comb += self.o.eq(degrees)
        return m
