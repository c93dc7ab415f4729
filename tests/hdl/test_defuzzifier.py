"""Defuzzifier: both sums, with no bit lost."""

from random import Random

import pytest

from softdepth.hdl.defuzzifier import Defuzzifier
from softdepth.rules import CONCLUSIONS, weight

from .support import config, observe, piped

KS = range(1, CONCLUSIONS + 1)


@pytest.mark.parametrize("maximum", [1, 12, 256, 768])
def test_numerator_and_denominator(maximum: int) -> None:
    random = Random(maximum)
    sets = [{k: maximum if k == j else 0 for k in KS} for j in KS]
    sets += [{k: 0 if k == j else maximum for k in KS} for j in KS]
    sets += [dict.fromkeys(KS, 0), dict.fromkeys(KS, maximum)]
    sets += [{k: random.randint(0, maximum) for k in KS} for _ in range(60)]
    clocks = [{"i": {f"y{k}": v for k, v in s.items()}} for s in sets]
    assert piped(Defuzzifier(maximum), clocks, "num") == [
        sum(v * weight(k) for k, v in s.items()) for s in sets
    ]
    assert piped(Defuzzifier(maximum), clocks, "den") == [sum(s.values()) for s in sets]


def test_maxima_are_those_of_all_conclusions_full() -> None:
    dut = Defuzzifier(config().one)
    assert (dut.num_maximum, dut.den_maximum) == (55 * 256, 11 * 256)
    observe(dut, [{}], "num")
