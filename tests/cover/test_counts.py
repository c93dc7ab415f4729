"""What Verilator counts is told by block and signal; a branch and a bit that nothing reaches are seen."""

import pytest

from softdepth.sim.build import TOP
from softdepth.sim.trials import Due, Trial
from tests.cover.counts import Found, Point, counted
from tests.cover.page import Explanation, explanations, missed, page

VERILOG = f"""
module {TOP}(clk, rst, i_valid, i_payload, i_ready, o_valid, o_payload, o_ready, status);
  input clk;
  input rst;
  input i_valid;
  input [2:0] i_payload;
  input o_ready;
  output i_ready;
  output o_valid;
  output [2:0] o_payload;
  output [1:0] status;
  reg [1:0] \\$1 ;
  reg [1:0] \\room.count = 0;
  assign i_ready = o_ready & ~rst;
  assign o_valid = i_valid & ~rst;
  assign o_payload = i_payload;
  assign status = \\room.count ;
  always @(posedge clk)
    \\room.count <= \\$1 ;
  always @* begin
    \\$1  = \\room.count ;
    if (i_valid & i_ready) begin
      if (i_payload == 5) begin
        \\$1  = \\room.count + 2;
      end else begin
        \\$1  = \\room.count ^ 1;
      end
    end
    if (rst) begin
      \\$1  = 0;
    end
  end
endmodule
"""
"""It passes on what it is given, and counts: 5 counts by 2, anything else turns the lower bit."""


def run(numbers: list[int]) -> Trial:
    return Trial(numbers, [Due(number, 7) for number in numbers], patience=50, settle=9)


@pytest.mark.slow
def test_what_nothing_reaches_is_told() -> None:
    lines = counted("line", VERILOG, [run([1, 2, 4, 7])])
    missed_lines = [each.point.what for each in lines if not each.reached]
    assert missed_lines == ["room.count: if of if (i_payload == 5) begin"]
    assert sum(each.reached for each in lines) >= 5
    assert not [each for each in counted("line", VERILOG, [run([1, 5, 4, 7])]) if not each.reached]


@pytest.mark.slow
def test_bits_that_do_not_change_both_ways_are_told() -> None:
    # Bit 1 of the count is set and never cleared; without the 5 it is not even set.
    for numbers, wanted in (([5, 1, 2], True), ([1, 4, 2], True), ([5, 5, 1, 2, 4], False)):
        found = counted("toggle", VERILOG, [run(numbers)])
        bits = {each.point: each.reached for each in found if each.point.block == "room"}
        assert bits[Point("toggle", "room", "count[0]")]
        assert bits[Point("toggle", "room", "count[1]")] != wanted
    constant = counted("toggle", VERILOG, [run([1, 2])], {"room.count[1]"})
    assert Point("toggle", "room", "count[1]") not in {each.point for each in constant}


FOUND = [
    Found(Point("line", "front.guard", "x: if of if (y)"), True),
    Found(Point("line", "front.guard", "x: if of if (z)"), False),
    Found(Point("toggle", "winners", "best[3]"), False),
    *[Found(Point("toggle", "median.queue", f"at[{k}]"), True) for k in range(1999)],
    Found(Point("toggle", "median.queue", "at[1999]"), False),
]


def test_what_is_not_reached_is_listed_with_its_reason() -> None:
    said = [Explanation("z is always low", kind="line", core="sad", what="z")]
    text = page({"sad": FOUND}, said, {("a",), ("b", "c")}, {("a",)}, "today")
    assert "| sad | lines | 50.0% of 2 | - | - | - | - | 50.0% of 2 |" in text
    assert "| sad | bits that change | - | - | 0.0% of 1 | 99.9% of 2,000 | - | 99.9% of 2,001 |" in text
    assert "| sad | `front.guard: x` | 1 | z is always low |" in text
    assert "| sad | `median.queue: at`, `winners: best` | 2 | not explained |" in text
    assert "reach 1 of the 2 bins" in text
    assert "b, c" in text


def test_an_explanation_must_fit_in_all() -> None:
    said = [
        Explanation("other", core="lite", what="z"),
        Explanation("mine", kind="toggle", block="^winners$"),
    ]
    by_reason = missed({"sad": FOUND}, said)
    assert {reason: len(points) for reason, points in by_reason.items()} == {"": 2, "mine": 1}


def test_explanations_can_be_read() -> None:
    for each in explanations():
        assert each.reason
        assert each.kind in ("line", "toggle")
        assert each.what
