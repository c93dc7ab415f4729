"""Proofs by yosys' own solver, and plain statements of arithmetic that they compare blocks with."""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

from amaranth.hdl import Array, Const, Module, Mux, Signal, Value
from amaranth.lib.wiring import Component

from softdepth.flow.tools import find_tool
from softdepth.hdl.text.rtlil import to_rtlil
from softdepth.spec.errors import ToolError
from tests.support.solver import asked

CLOCKS = 14
LIMIT = 300
"""Seconds that a solver may take; one that takes longer has found nothing, which is no proof."""
Proof = Literal["every run", "runs of some clocks", "refuted"]


PREPARED = (
    "read_rtlil dut.il; hierarchy -top dut; {cut} proc; flatten; memory_map; async2sync; dffunmap;"
    " chformal -lower; setundef -undriven -zero;"
    # yosys' pass for flip-flops stumbles over wires that others have joined: these are tidied up first.
    " opt_merge; opt_clean; opt_dff; opt_clean; opt -full;"
)


SAID: list[str] = []
"""How far each proof went since the list was last looked at: what the table of proofs says."""


def every_run(dut: Component, folder: Path, *, without: str = "") -> Proof:
    """What is known of the assertions in `dut`, whose inputs are free but for its reset, in every run.

    By ABC's `pdr`, which finds its own invariants or a run that fails; `without` as of `proof`. Fails where
    it finds neither within `LIMIT`.
    """
    (folder / "dut.il").write_text(to_rtlil(dut, "dut"))
    found = asked(PREPARED.format(cut=_cut(without)), folder, f"pdr,-T,{LIMIT}")
    SAID.append("every run" if found == "proven" else found)
    return "every run" if found == "proven" else "refuted"


def some_clocks(dut: Component, folder: Path, clocks: int, *, without: str = "") -> Proof:
    """The same of every run of so many clocks from reset on, by ABC's `bmc3`."""
    (folder / "dut.il").write_text(to_rtlil(dut, "dut"))
    found = asked(PREPARED.format(cut=_cut(without)), folder, f"bmc3,-F,{clocks + 1},-T,{LIMIT}", clocks)
    SAID.append(found if found == "refuted" else f"{clocks} clocks")
    return "refuted" if found == "refuted" else "runs of some clocks"


def _cut(without: str) -> str:
    return " ".join(f"delete t:{pattern};" for pattern in without.split())


def proof(
    dut: Component,
    folder: Path,
    *,
    clocks: int = CLOCKS,
    induction: bool = True,
    without: str = "",
) -> Proof:
    """What is known of the assertions in `dut`, whose inputs are free but for its reset.

    They hold of every run, by induction over up to `clocks` clocks; or of every run of so many clocks from
    reset on, where induction does not close or is not tried; or there is a run in which one fails. Modules
    whose names match one of the patterns `without` are cut out, and their outputs 0: what a statement is not
    about.
    """
    said = _solved(
        dut,
        folder,
        f"setundef -init -zero; sat -set rst 0 -maxsteps {clocks}"
        f" -tempinduct{'' if induction else '-baseonly'}",
        _cut(without),
    )
    if said is not None and "model found for base case: FAIL" in said:
        SAID.append("refuted")
        return "refuted"
    if said is None and induction:
        SAID.append("every run")
        return "every run"
    assert said is None or "Reached maximum number of time steps" in said, said[-500:]
    SAID.append(f"{clocks} clocks")
    return "runs of some clocks"


def pipeline_proof(dut: Component, folder: Path, latency: int) -> Proof:
    """The same of a pipeline, whose registers hold nothing older than `latency` clocks.

    It begins in any state, and the assertions are looked at once that state has left. So this is every run.
    """
    said = _solved(
        dut, folder, f"setattr -unset init w:*; sat -set rst 0 -seq {latency + 1} -prove-skip {latency}"
    )
    if said is None:
        SAID.append("every run")
        return "every run"
    assert "model found: FAIL" in said, said[-500:]
    SAID.append("refuted")
    return "refuted"


def _solved(dut: Component, folder: Path, script: str, cut: str = "") -> str | None:
    """What yosys says of a failed proof, None of one that did not fail."""
    (folder / "dut.il").write_text(to_rtlil(dut, "dut"))
    script = f"{PREPARED.format(cut=cut)} {script} -timeout {LIMIT} -prove-asserts -set-assumes -verify dut"
    try:
        find_tool("yosys").run(["-q", "-l", "log", "-p", script], folder, log="log")
    except ToolError:
        return (folder / "log").read_text()
    return None


def late(m: Module, value: Value, clocks: int, name: str) -> Signal:
    """`value` as it was `clocks` ago."""
    now = Signal(value.shape(), name=name)
    m.d.comb += now.eq(value)
    for clock in range(clocks):
        before = Signal.like(now, name=f"{name}_{clock + 1}")
        m.d.sync += before.eq(now)
        now = before
    return now


def looked_up(table: Mapping[tuple[int, ...], int], *values: Value) -> Value:
    """An entry of a table by non-negative values, 0 where it has none."""
    if not values or not table:
        return Const(table.get((), 0), max(1, max(table.values(), default=0).bit_length()))
    first, *rest = values
    parts = [{key[1:]: v for key, v in table.items() if key[0] == k} for k in range(1 << len(first))]
    return Value.cast(Array(looked_up(part, *rest) for part in parts)[first])


def largest(values: list[Value]) -> Value:
    """The largest, found one after the other."""
    found = values[0]
    for value in values[1:]:
        found = Mux(value > found, value, found)
    return found
