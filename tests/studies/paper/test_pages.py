"""The words and tables: what they say of made-up figures."""

import json

import pytest

from softdepth.spec.config import OPERATORS
from softdepth.spec.errors import InputError
from softdepth.studies.paper import pages
from softdepth.studies.paper.speed import Speed, Speeds, with_luts


def speeds(**times: tuple[float, float]) -> Speeds:
    return Speeds(
        processor="a processor",
        rows=1,
        multipliers=156,
        operators=[
            Speed(
                operator=o,
                float_ns=times.get(o, (9.0, 9.0))[0],
                fixed_ns=times.get(o, (9.0, 9.0))[1],
                lanes=4 if o == "prod" else 32,
                clocks=16 if o == "prod" else 2,
                multipliers=100,
            )
            for o in OPERATORS
        ],
    )


def test_conclusion_4_is_judged_by_the_figures():
    holds = pages.conclusion_4(speeds(mean=(2, 3), min=(4, 4)))
    assert "it holds in float; it holds in fixed" in holds
    fails = pages.conclusion_4(speeds(mean=(6, 3), prod=(4, 8)))
    assert "not in float, where PROD is (1.50 times as fast); it holds in fixed" in fails
    assert "In gateware MIN, MEAN, Soft-min I, Soft-min II take the fewest clocks" in fails
    tie = pages.conclusion_4(speeds(mean=(6, 3), min=(5.9, 4)))
    assert "in float it is no slower than any, and no faster than MIN; it holds in fixed" in tie
    same = speeds(mean=(6, 3))
    for each in same.operators:
        each.clocks = 4
    assert "all operators take the same clocks" in pages.conclusion_4(same)


def test_luts_are_read_where_they_are(tmp_path):
    path = tmp_path / "area.json"
    assert with_luts(speeds(), path) == speeds()
    assert {row[-1] for row in pages.speed_rows(speeds())} == {"not measured"}
    path.write_text(json.dumps({"lanes": {"mean": {"lut4": 1234}, "min": {"lut4": 900}}}))
    rows = {row[0]: row[-1] for row in pages.speed_rows(with_luts(speeds(), path))}
    assert rows["MEAN"] == "1,234"
    assert rows["MIN"] == "900"
    assert rows["PROD"] == "not measured"
    path.write_text("{")
    with pytest.raises(InputError, match=r"cannot read .*area"):
        with_luts(speeds(), path)


def test_numbers():
    assert pages.figure(None) == "-"
    assert pages.figure(1.005, sign=True) == "+1.00"
    assert pages.figure(-0.126, sign=True) == "-0.13"
    assert (pages.below(12.6), pages.below(-3.2)) == ("13 % below", "3 % above")
