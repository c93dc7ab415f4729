"""The compensating rule against false near objects (Bobyr et al. 2021, section 4, step 3)."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.costs.criteria import criteria_layout
from softdepth.hdl.thresholds import threshold
from softdepth.spec.config import LITERAL_INPUT, Config


class Compensation(wiring.Component):
    """Replaces all criteria of a near candidate whose SAD is too large.

    Near candidates are those of ``d >= from_disparity``. They get the top label 2T, or 1000 in the
    literal reading. One candidate a clock, one clock of latency, also when the rule is off.

    Members
    -------
    near : the candidate's disparity reaches ``from_disparity``.
    i, o : the criteria before and after.
    """

    latency = 1

    def __init__(self, config: Config) -> None:
        self._config = config
        self._threshold = threshold("compensated", config.compensation.threshold)
        self.maxima = [
            max(maximum, _replacement(config, c.label_bits))
            for c, maximum in zip(config.criteria, config.maxima, strict=True)
        ]
        super().__init__(
            {
                "near": In(1),
                "i": In(criteria_layout(config.maxima)),
                "o": Out(criteria_layout(self.maxima)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        rule = self._config.compensation
        replace = Signal()
        if rule.reading != "off":
            seen = self.i[f"s{self._config.compensation_criterion}"]
            m.d.comb += replace.eq(self.near & (seen > self._threshold))
        output = Signal(self.o.shape(), reset_less=True)
        for i, criterion in enumerate(self._config.criteria):
            replacement = _replacement(self._config, criterion.label_bits)
            m.d.sync += output[f"s{i}"].eq(Mux(replace, replacement, self.i[f"s{i}"]))
        m.d.comb += self.o.eq(output)
        return m


def _replacement(config: Config, label_bits: int) -> int:
    """What the rule gives a criterion; 0 when the rule is off."""
    return {"off": 0, "top": 2 << label_bits, "literal": LITERAL_INPUT}[config.compensation.reading]
