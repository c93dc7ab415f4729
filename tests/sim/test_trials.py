"""Trials: each rule of the bench is broken once by a small stream register with faults to choose from."""

from dataclasses import replace

import pytest

from softdepth.sim.build import TOP
from softdepth.sim.trials import Due, Trial, run_trials
from softdepth.spec.errors import ToolError

VERILOG = f"""\
module {TOP}(clk, rst, i_valid, i_payload, i_ready, o_valid, o_payload, o_ready, status, mutant);
  input clk;
  input rst;
  input i_valid;
  input [7:0] i_payload;
  output i_ready;
  output o_valid;
  output [7:0] o_payload;
  input o_ready;
  output [63:0] status;
  input [15:0] mutant;
  reg full = 0;
  reg [7:0] word;
  reg [63:0] clock = 0, taken = 0;
  assign i_ready = ~full & (~rst | mutant == 1) & ~(mutant == 7 & taken == 5) & ~(mutant == 8 & clock[1]);
  assign o_valid = full & ~(mutant == 2 & clock[2]);
  assign o_payload = word ^ (mutant == 3 & clock[2]) ^ (mutant == 4 & taken == 3);
  assign status = taken + (mutant == 5 & taken > 3);
  always @(posedge clk) begin
    clock <= clock + 1;
    if (i_valid & i_ready) begin
      full <= 1;
      word <= i_payload;
      taken <= taken + 1;
    end
    if (full & o_valid & o_ready) full <= mutant == 6 & taken == 9;
    if (rst & mutant != 9) begin
      full <= 0;
      taken <= 0;
      clock <= 0;
    end
  end
endmodule
"""
WORDS = range(1, 11)
TRIAL = Trial(list(WORDS), [Due(word, 0xFF) for word in WORDS], status=len(WORDS), patience=50, settle=20)
STALLED = replace(TRIAL, o_pause=900, i_pause=200)
FAULTS = {
    1: "a pixel is taken in reset",
    2: "an offer is withdrawn",
    3: "an offer is altered",
    4: "result 2 is wrong",
    5: "a counter is wrong",
    6: "result 9 is wrong",
    7: "it stops",
    8: "it takes 37 clocks",
}


@pytest.mark.slow
def test_each_rule_finds_its_fault() -> None:
    trials = [STALLED, replace(TRIAL, limit=25)]
    sound, *verdicts = run_trials(VERILOG, trials, [0, *FAULTS, 9])
    assert sound.trial is None
    assert [verdict.wrong for verdict in verdicts[:-1]] == list(FAULTS.values())
    assert all(verdict.trial is not None for verdict in verdicts[:-1])
    assert verdicts[-1].wrong, "a run that a reset does not clear"


@pytest.mark.slow
def test_results_that_do_not_count() -> None:
    some = replace(TRIAL, due=TRIAL.due[:4], status=None)
    none = replace(TRIAL, due=[Due(0, 0) for _ in WORDS])
    cut = replace(TRIAL, due=[Due(0, 0xFF)], cut=1)
    passes = [replace(some, exact=False), none, cut]
    assert [run_trials(VERILOG, [trial], [0])[0].trial for trial in passes] == [None] * 3
    assert run_trials(VERILOG, [some], [0])[0].wrong == "there are too many results"
    assert run_trials(VERILOG, [TRIAL, none, some, TRIAL], [0])[0].trial == 2


def test_a_payload_that_is_too_long_is_refused() -> None:
    with pytest.raises(ToolError, match="a payload of 99 bits is longer"):
        run_trials(VERILOG.replace("[7:0] i_payload", "[98:0] i_payload"), [TRIAL])
