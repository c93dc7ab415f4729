"""Lookup tables go into carry cells where they fit, and the netlist computes what it did."""

import copy
import json
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from amaranth.hdl import Cat, Module, Mux
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from numpy.typing import NDArray

from softdepth.flow.families.ecp5.fuse import fuse_carries
from softdepth.flow.synthesis import TOP, Netlist, cells, synthesise
from softdepth.flow.tools import find_tool, share_folder
from tests.flow.circuits import ADD, Bit, Circuit, outputs

XOR, AND, MUX, OR3 = 0x6666, 0x8888, 0xCACA, 0xFEFE
"""Tables of two and three inputs; MUX is ``C ? B : A``."""


def same(before: Netlist, after: Netlist) -> bool:
    """Whether two netlists put out the same for every input."""
    one, other = outputs(before), outputs(after)
    return one.keys() == other.keys() and all((one[name] == other[name]).all() for name in one)


def fused(circuit: Circuit) -> tuple[Netlist, int]:
    """The netlist after the pass, which must compute the same, and how many tables went."""
    before = circuit.netlist
    after = copy.deepcopy(before)
    count = fuse_carries(after)
    assert count == cells(before)["LUT4"] - cells(after)["LUT4"]
    assert cells(before)["CCU2C"] == cells(after)["CCU2C"]
    assert same(before, after)
    return after, count


def adder(first: Callable[[Circuit, Bit], Bit], second: Callable[..., Bit], shared: int = 0) -> Circuit:
    """Two bits of ``first(a) + second(b, c, s...) + cin``, with ``shared`` inputs that both bits use."""
    circuit = Circuit()
    a, b, c = (circuit.input(name, 2) for name in "abc")
    both = circuit.input("s", shared)
    (cin,) = circuit.input("cin", 1)
    halves = [[first(circuit, a[k]), second(circuit, b[k], c[k], *both), "0", "1"] for k in (0, 1)]
    circuit.output("sum", circuit.carry((ADD, ADD), halves, cin))
    return circuit


def plain(circuit: Circuit, a: Bit) -> Bit:
    return a


KINDS: dict[str, tuple[Circuit, int]] = {
    "inverted where s": (adder(plain, lambda m, b, c, s: m.lut(XOR, b, s), 1), 2),
    "masked": (adder(plain, lambda m, b, c, s: m.lut(AND, b, s), 1), 2),
    "chosen": (adder(plain, lambda m, b, c, s: m.lut(MUX, b, c, s), 1), 2),
    "inverted": (adder(plain, lambda m, b, c: m.lut(0x5555, b)), 2),
    "both inverted where s": (
        adder(lambda m, a: m.lut(0x5555, a), lambda m, b, c, s: m.lut(XOR, b, s), 1),
        4,
    ),
    "a constant operand": (adder(lambda m, a: "0", lambda m, b, c, s: m.lut(MUX, b, c, s), 1), 2),
    "one behind the other": (adder(plain, lambda m, b, c, s: m.lut(0x5555, m.lut(AND, b, s)), 1), 4),
    "five inputs are too many": (adder(plain, lambda m, b, c, s, t: m.lut(0x1EE1, b, c, s, t), 2), 0),
}


@pytest.mark.parametrize("kind", KINDS)
def test_tables_that_fit_go(kind):
    circuit, expected = KINDS[kind]
    assert fused(circuit)[1] == expected


@pytest.mark.parametrize("reader", ["port", "table", "carry in"])
def test_a_table_that_another_reads_stays(reader):
    circuit = Circuit()
    a, b = (circuit.input(name, 2) for name in "ab")
    (s, cin) = circuit.input("s", 2)
    table = circuit.lut(XOR, b[0], s)
    sums = circuit.carry((ADD, ADD), [[a[0], table, "0", "1"], [a[1], b[1], "0", "1"]], cin)
    if reader == "port":
        sums.append(table)
    elif reader == "table":
        sums.append(circuit.lut(AND, table, a[1]))
    else:
        sums += circuit.carry((ADD, ADD), [[a[0], b[0], "0", "1"], [a[1], b[1], "0", "1"]], table)
    circuit.output("o", sums)
    before = cells(circuit.netlist)
    after, count = fused(circuit)
    assert count == 0
    assert cells(after) == before


@pytest.mark.parametrize("fits", [True, False])
def test_a_table_of_two_readers_goes_into_both_or_stays(fits):
    circuit = Circuit()
    a, b, c = (circuit.input(name, 2) for name in "abc")
    s, t, cin = circuit.input("s", 3)
    table = circuit.lut(XOR, b[0], s)
    other = table if fits else circuit.lut(OR3, table, c[0], t)  # a table, which is no carry cell
    sums = circuit.carry((ADD, ADD), [[a[0], table, "0", "1"], [a[1], b[1], "0", "1"]], cin)
    sums += circuit.carry((ADD, ADD), [[c[0], b[1], "0", "1"], [c[1], other, "0", "1"]], "0")
    circuit.output("o", sums)
    assert fused(circuit)[1] == (1 if fits else 0)


def test_a_table_on_both_operands():
    circuit = Circuit()
    b, s, cin = (circuit.input(name, 1)[0] for name in ("b", "s", "cin"))
    table = circuit.lut(XOR, b, s)
    circuit.output("o", circuit.carry((ADD, ADD), [[table, table, "0", "1"], [b, s, "0", "1"]], cin))
    assert fused(circuit)[1] == 1


def test_a_half_that_begins_a_chain_stays():
    """Where INJECT1 is set the half's generate is gone: the pass leaves it alone."""
    circuit = Circuit()
    a, b, s = (circuit.input(name, 1)[0] for name in "abs")
    circuit.output(
        "o", circuit.carry((ADD, ADD), [[a, circuit.lut(XOR, b, s), "0", "1"], [a, b, "0", "1"]], "0")
    )
    (carry,) = (c for c in circuit.netlist["modules"][TOP]["cells"].values() if c["type"] == "CCU2C")
    carry["parameters"]["INJECT1_0"] = "YES"
    assert fused(circuit)[1] == 0


def test_an_unknown_constant_stays():
    circuit = Circuit()
    a, b, s = (circuit.input(name, 1)[0] for name in "abs")
    circuit.output(
        "o", circuit.carry((ADD, ADD), [[a, circuit.lut(XOR, b, s), "x", "1"], [a, b, "0", "1"]], "0")
    )
    assert fuse_carries(circuit.netlist) == 0


def drawn(seed: int) -> Circuit:
    """Tables and carry cells of any contents, wired at random: most are no adders."""
    rng = random.Random(seed)
    circuit = Circuit()
    nets: list[Bit] = [*circuit.input("i", 6)]
    sums: list[Bit] = []

    def pins(count: int) -> list[Bit]:
        return [rng.choice([*nets, "0", "1"] if rng.random() < 0.3 else nets) for _ in range(count)]

    tables = [circuit.lut(init(rng), *pins(rng.randint(1, 4))) for _ in range(rng.randint(1, 4))]
    carry: Bit = rng.choice(["0", "1", nets[0]])
    for _ in range(2):
        halves = [[rng.choice(tables), *pins(1), *rng.choice([["0", "1"], pins(2)])] for _ in range(2)]
        for half in halves:
            rng.shuffle(half)
        *found, carry = circuit.carry((init(rng), init(rng)), halves, carry)
        sums += found
    circuit.output("o", [*sums, carry])
    return circuit


def init(rng: random.Random) -> int:
    return rng.choice((ADD, XOR, AND, MUX, OR3, 0x5555, 0x8778, rng.getrandbits(16)))


def test_random_circuits_compute_the_same():
    counts = [fused(drawn(seed))[1] for seed in range(400)]
    assert sum(count > 0 for count in counts) > 100
    assert sum(count == 0 for count in counts) > 30


def wrong(netlist: Netlist) -> Iterator[tuple[str, Netlist]]:
    """The netlist with one bit flipped in a carry cell's table, for every bit that an input reaches."""
    for name, cell in netlist["modules"][TOP]["cells"].items():
        if cell["type"] != "CCU2C":
            continue
        for half in "01":
            pins = [cell["connections"][pin + half][0] for pin in "ABCD"]
            for address in range(16):
                if any(str(1 - (address >> k & 1)) == pin for k, pin in enumerate(pins)):
                    continue  # a pin is tied to the other value
                found = copy.deepcopy(netlist)
                bits = list(reversed(found["modules"][TOP]["cells"][name]["parameters"][f"INIT{half}"]))
                bits[address] = "10"[int(bits[address])]
                found["modules"][TOP]["cells"][name]["parameters"][f"INIT{half}"] = "".join(reversed(bits))
                yield f"{name} INIT{half}[{address}]", found


@pytest.mark.parametrize("kind", ["inverted where s", "chosen"])
def test_one_wrong_bit_is_seen_by_the_comparison_here(kind):
    circuit, _ = KINDS[kind]
    after, _ = fused(circuit)
    broken = list(wrong(after))
    assert len(broken) >= 16
    for where, netlist in broken:
        assert not same(circuit.netlist, netlist), where


BITS = 6
TOP_VALUE = (1 << BITS) - 1

Expression = Callable[[Any, Any, Any, Any], Any]

EXPRESSIONS: dict[str, tuple[Expression, Expression, int]] = {
    "inverted where s": (
        lambda a, b, c, s: a + (b ^ s.replicate(BITS)),
        lambda a, b, c, s: a + (b ^ TOP_VALUE * s),
        0,
    ),
    "chosen": (
        lambda a, b, c, s: a + Mux(s, b, c),
        lambda a, b, c, s: a + np.where(s, b, c),
        0,
    ),
    "masked": (
        lambda a, b, c, s: a + Mux(s, b, 0),
        lambda a, b, c, s: a + b * s,
        0,
    ),
    "both masked": (
        lambda a, b, c, s: Mux(s, a, 0) + Mux(c[0], b, 0),
        lambda a, b, c, s: a * s + b * (c % 2),
        0,
    ),
    "with a carry": (
        lambda a, b, c, s: Cat(s, a) + Cat(s, b ^ s.replicate(BITS)),
        lambda a, b, c, s: 2 * (a + (b ^ TOP_VALUE * s)) + 2 * s,
        0,
    ),
    # Where both of the choice's inputs that a carry does not see are 0, the choice must be 0.
    "one choice inverted": (
        lambda a, b, c, s: a + Mux(s, b, ~c),
        lambda a, b, c, s: a + np.where(s, b, TOP_VALUE ^ c),
        BITS,
    ),
}
"""Additions behind choices: as hardware, as numbers, and how many tables do not fit into carry cells."""


class Sum(wiring.Component):
    """One of `EXPRESSIONS`."""

    def __init__(self, build: Expression) -> None:
        self._build = build
        super().__init__({"a": In(BITS), "b": In(BITS), "c": In(BITS), "s": In(1), "o": Out(BITS + 2)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.comb += self.o.eq(self._build(self.a, self.b, self.c, self.s))
        return m


def columns() -> dict[str, NDArray[np.int64]]:
    """Inputs of a `Sum` at random."""
    rng = np.random.default_rng(1)
    return {"s": rng.integers(0, 2, 4000), **{name: rng.integers(0, 1 << BITS, 4000) for name in "abc"}}


def proof(one: Netlist, other: Netlist, folder: Path) -> str:
    """What yosys' solver says of two netlists, by yosys' own models of the cells."""
    tool = find_tool("yosys")
    for name in ("common_sim.vh", "ccu2c_sim.vh"):
        (folder / name).write_text((share_folder(tool) / "lattice" / name).read_text())
    for name, netlist in (("one", one), ("other", other)):
        alone = {"modules": {TOP: netlist["modules"][TOP]}}  # without the library's modules
        (folder / f"{name}.json").write_text(json.dumps(alone))
    script = (
        f"read_json one.json; rename {TOP} gold; read_json other.json; rename {TOP} gate;"
        " read_verilog -DNO_INCLUDES common_sim.vh ccu2c_sim.vh;"
        " miter -equiv gold gate miter; hierarchy -top miter; proc; flatten; sat -prove trigger 0 miter"
    )
    return tool.run(["-q", "-l", "proof.log", "-p", script], folder, log="proof.log")


@pytest.mark.slow
@pytest.mark.parametrize("name", EXPRESSIONS)
def test_additions_mapped_by_yosys(name, tmp_path):
    """Fewer cells, the same function: by arithmetic, by yosys' proof, which finds a wrong bit too."""
    build, function, stay = EXPRESSIONS[name]
    before = synthesise(Sum(build), "ecp5", tmp_path, passes=())
    after = copy.deepcopy(before)
    assert fuse_carries(after) == cells(before)["LUT4"] - stay
    assert cells(before)["LUT4"] >= BITS
    assert (cells(after)["LUT4"], cells(after)["CCU2C"]) == (stay, cells(before)["CCU2C"])

    inputs = columns()
    expected = function(**inputs) % (1 << BITS + 2)
    assert (outputs(after, inputs)["o"] == expected).all()
    assert "no model found: SUCCESS!" in proof(before, after, tmp_path)

    broken = next(n for _, n in wrong(after) if (outputs(n, inputs)["o"] != expected).any())
    assert "model found: FAIL!" in proof(before, broken, tmp_path)
