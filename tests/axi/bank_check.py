"""A register bank behind Wishbone against a plain model of the description, clock by clock."""

from collections.abc import Sequence
from random import Random
from typing import Any

from amaranth.hdl import Module, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.sim import SimulatorContext

from softdepth.hdl.axi.register_bank import LANES, word_bits
from softdepth.hdl.axi.wishbone import wishbone
from softdepth.spec.registers import WORD_BITS, Register
from tests.support.simulation import simulate


class BankOnWishbone(wiring.Component):
    """The two as the core connects them: the bus's ports, and what the bank shows the core."""

    def __init__(self, bank: Any, adapter: Any) -> None:
        self._bank, self._adapter = bank, adapter
        inside = bank.signature.members
        super().__init__(
            {
                **{name: adapter.signature.members[name] for name in wishbone(1)},
                "held": Out(inside["held"].shape),
                "given": In(inside["given"].shape),
                "takeover": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.bank, m.submodules.adapter = bank, adapter = self._bank, self._adapter
        wiring.connect(m, adapter.bus, bank.bus)
        for name in ("cyc", "stb", "we", "adr", "sel", "dat_w"):
            m.d.comb += getattr(adapter, name).eq(getattr(self, name))
        m.d.comb += [
            self.dat_r.eq(adapter.dat_r),
            self.ack.eq(adapter.ack),
            self.held.eq(bank.held),
            bank.given.eq(self.given),
            self.takeover.eq(bank.takeover),
        ]
        return m


class BankModel:
    """What the description says of each clock.

    Members
    -------
    held : values of the fields that software writes.
    read : what the newest read found.
    takeover : a register with `Register.takeover` was written in the clock before.
    """

    def __init__(self, registers: Sequence[Register]) -> None:
        self._registers = {register.address // LANES: register for register in registers}
        self.held = {f.name: f.reset for r in registers for f in r.fields if f.writable}
        self.read = 0
        self.takeover = False

    def clock(self, given: dict[str, int], read: int | None, write: tuple[int, int, int] | None) -> None:
        """One clock: what the core gives, which word is read, and word, bytes and data that are written."""
        if read is not None:
            self.read = self._shown(read, given)
        word, lanes, data = write or (None, 0, 0)
        mask = sum(0xFF << 8 * lane for lane in range(LANES) if lanes >> lane & 1)
        for number, register in self._registers.items():
            for field in register.fields:
                if not field.writable:
                    continue
                all_bits = (1 << field.width) - 1
                old = self.held[field.name]
                new, chosen = data >> field.low & all_bits, mask >> field.low & all_bits
                chosen = chosen if number == word else 0
                if field.sticky:
                    now = old & ~(new & chosen) | given[field.name]
                elif field.pulses:
                    now = new & chosen
                else:
                    now = old & ~chosen | new & chosen
                self.held[field.name] = now
        self.takeover = word in self._registers and self._registers[word].takeover

    def _shown(self, word: int, given: dict[str, int]) -> int:
        register = self._registers.get(word)
        shown = 0
        for field in register.fields if register else ():
            if field.pulses:
                continue
            if field.writable:
                value = self.held[field.name]
            else:
                value = given[field.name] if field.given else field.reset
            shown |= value << field.low
        return shown


def check_bank(registers: Sequence[Register], bank: Any, adapter: Any, *, clocks: int, seed: int = 0) -> None:
    """Random accesses, with random events in the core; fails in the first clock that is not as described.

    An access is held until it is answered. In between, the bus idles, or has only one of ``cyc`` and ``stb``
    set, as during the access of another target.
    """
    random = Random(seed)
    dut = BankOnWishbone(bank, adapter)
    model = BankModel(registers)
    fields = {f.name: f for r in registers for f in r.fields if f.given}

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        access, answered, wrote = False, False, False
        bus: dict[str, int] = {}
        for clock in range(clocks):
            if not access or answered:
                access = random.random() < 0.7
                lone = random.choice(({}, {"cyc": 1}, {"stb": 1}))
                bus = {
                    **({"cyc": 1, "stb": 1} if access else {"cyc": 0, "stb": 0, **lone}),
                    "we": random.getrandbits(1),
                    "adr": random.randrange(1 << word_bits(registers)),
                    "sel": random.getrandbits(LANES) if random.getrandbits(1) else (1 << LANES) - 1,
                    "dat_w": random.getrandbits(WORD_BITS),
                }
            given = {
                name: random.random() < 0.1 if field.sticky else random.getrandbits(field.width)
                for name, field in fields.items()
            }
            for name, value in bus.items():
                ctx.set(getattr(dut, name), value)
            ctx.set(dut.given, given)
            _, _, ack, dat_r, held, takeover = await ctx.tick().sample(
                dut.ack, dut.dat_r, Value.cast(dut.held), dut.takeover
            )
            held = dut.held.shape().from_bits(held)
            assert ack == answered, f"clock {clock}: ack is {ack}"
            if answered and not wrote:
                assert dat_r == model.read, f"clock {clock}: {dat_r:#x} was read, not {model.read:#x}"
            for name, value in model.held.items():
                assert held[name] == value, f"clock {clock}: {name} is {held[name]:#x}, not {value:#x}"
            assert takeover == model.takeover, f"clock {clock}: takeover is {takeover}"
            begins = access and not answered
            wrote = begins and bool(bus["we"])
            model.clock(
                given,
                bus["adr"] if begins and not wrote else None,
                (bus["adr"], bus["sel"], bus["dat_w"]) if wrote else None,
            )
            answered = begins

    simulate(dut, bench)
