"""The core with AXI4-Stream Video in and out, and registers."""

from amaranth.hdl import Cat, ClockDomain, ClockSignal, Module, Mux, ResetSignal, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.axi.axi_lite import AxiLite, axi_lite
from softdepth.hdl.axi.frames import Frames
from softdepth.hdl.axi.inputs import PREFIX, OneStream, TwoStreams, axi_stream
from softdepth.hdl.axi.markers import Markers
from softdepth.hdl.axi.register_bank import RegisterBank, word_bits
from softdepth.hdl.axi.tdata import bits_of, extended, outcome_layout
from softdepth.hdl.axi.wishbone import Wishbone, wishbone
from softdepth.hdl.core import StereoCore
from softdepth.hdl.signatures import Faults, Status, settings_layout, threshold_limits
from softdepth.hdl.winners.layout import is_measured
from softdepth.spec.axi_options import DEFAULT, AxiOptions
from softdepth.spec.bus import Bus
from softdepth.spec.config import Config
from softdepth.spec.registers import UNSURE, registers
from softdepth.spec.validity import Validity

BUSES: dict[Bus, tuple] = {"axi-lite": ("s_axil", axi_lite, AxiLite), "wishbone": ("wb", wishbone, Wishbone)}
"""Prefix of the ports, the ports, and the component, of each bus of the registers."""

FLAGS = {
    "short_lines": "flags_short_line",
    "long_lines": "flags_long_line",
    "early_starts": "flags_early_start",
    "missing_starts": "flags_missing_start",
}
"""The flag that each fault raises."""


THRESHOLDS = {
    "tolerance": "check_tolerance",
    "island": "island_least",
    "compensated": "compensation_threshold",
    "truncation": "truncation_value",
    "like": "likeness_like",
}
"""The register field that sets each threshold of a core."""


class AxiCore(wiring.Component):
    """A stereo core that drops into a design of AXI4-Stream Video.

    Registers that take effect with the next frame are copied while the core is empty: after a write to one
    of them, a new frame waits until all earlier frames' results have left. So no frame is computed with a
    mix of old and new values, and each result is that of the configuration with the frame's values.

    Throughput and latency are the core's; nothing is added to them.

    Members
    -------
    aclk, aresetn : clock, and reset, active low and synchronous.
    s_axis_* : both views' pixels, `pair_bits`; ``tuser`` starts a frame, ``tlast`` ends a line. Or
    s_axis_left_*, s_axis_right_* : one view each, `view_bits`, joined by `TwoStreams`.
    m_axis_* : results, `outcome_layout`, one for each pixel.
    s_axil_*, or wb_* : the registers.
    irq : a level, high while a flag is set whose interrupt is enabled.
    """

    def __init__(self, config: Config, options: AxiOptions = DEFAULT) -> None:
        self._config, self._outcome = config, outcome_layout(config, left=options.left)
        self._bus: Bus = options.bus
        self._source = TwoStreams(config, options) if options.two else OneStream(config)
        self._core = StereoCore(config, settings=True, left=options.left)
        self._registers = registers(config, options)
        prefix, ports, _ = BUSES[self._bus]
        streams = {name: member for name, member in self._source.signature.members.items() if _is_port(name)}
        super().__init__(
            {
                "aclk": In(1),
                "aresetn": In(1),
                **streams,
                **axi_stream("m_axis", self._outcome.size, Out),
                **{f"{prefix}_{name}": member for name, member in ports(word_bits(self._registers)).items()},
                "irq": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.domains.sync = ClockDomain(local=True)
        m.d.comb += [ClockSignal().eq(self.aclk), ResetSignal().eq(~self.aresetn)]
        m.submodules.core = core = self._core
        m.submodules.markers = markers = Markers()
        m.submodules.frames = frames = Frames(self._most_frames)
        m.submodules.bank = bank = RegisterBank(self._registers)
        prefix, _, adapter = BUSES[self._bus]
        m.submodules.bus = bus = adapter(word_bits(self._registers))
        wiring.connect(m, bus.bus, bank.bus)
        for name, member in bus.signature.members.items():
            if name != "bus":
                _through(m, member, getattr(self, f"{prefix}_{name}"), getattr(bus, name))
        m.submodules.source = source = self._source
        for name, member in source.signature.members.items():
            if _is_port(name):
                _through(m, member, getattr(self, name), getattr(source, name))

        held, given = bank.held, bank.given
        applied = self._taken_over(m, bank, frames)
        pair, come = core.i.payload, source.o.payload
        m.d.comb += [
            core.i.valid.eq(source.o.valid),
            source.o.ready.eq(core.i.ready),
            pair.left.eq(come.left),
            pair.right.eq(come.right),
            pair.sof.eq(come.sof),
            pair.eol.eq(markers.eol),
            pair.eof.eq(markers.eof),
            markers.taken.eq(core.i.valid & core.i.ready),
            markers.sof.eq(come.sof),
            markers.last.eq(come.last),
            markers.width.eq(applied.geometry_width),
            markers.height.eq(applied.geometry_height),
            frames.begins.eq(markers.taken & come.sof & ~core.settings.skip),
            core.settings.skip.eq(~held.control_enable),
            core.settings.clear.eq(held.control_clear),
            frames.clear.eq(held.control_clear),
        ]
        if isinstance(source, TwoStreams):
            m.d.comb += [
                source.by_count.eq(applied.geometry_width.any()),
                source.between.eq(markers.between),
                source.clear.eq(held.control_clear),
                given.flags_alignment.eq(source.lost),
                given.flags_skew.eq(source.waits),
                given.alignment_losses_count.eq(source.losses),
            ]
        self._thresholds(m, applied)
        self._give(m, applied, frames)

        m.d.comb += [
            given.status_busy.eq(frames.busy),
            given.flags_frame.eq(frames.ended),
            given.frames_count.eq(frames.count),
            given.seen_width.eq(frames.width),
            given.seen_height.eq(frames.height),
            *(given[FLAGS[name]].eq(core.faults[name]) for name in Faults.members),
            *(given[f"{name}_count"].eq(core.status[name]) for name in Status.members),
            self.irq.eq(_any_of(held, "flags", "interrupts")),
        ]
        return m

    @property
    def _most_frames(self) -> int:
        """Frames that can be in the core at once: no frame has fewer pixels than `Config.min_width`."""
        config = self._config
        lines = 2 * config.max_height
        return config.max_width * lines // config.min_width

    def _taken_over(self, m: Module, bank: RegisterBank, frames: Frames) -> data.View:
        """The register values with which the frames in the core are computed."""
        held = bank.held
        fields = [f for r in self._registers if r.takeover for f in r.fields]
        layout = data.StructLayout({f.name: f.width for f in fields})
        applied = Signal(layout, init={f.name: f.reset for f in fields})
        pending = Signal()
        taken = Signal()
        m.d.comb += [self._core.settings.hold.eq(pending), bank.given.status_pending.eq(pending)]
        with m.If(bank.takeover):
            m.d.sync += pending.eq(1)
        with m.Elif(pending & ~frames.busy):
            m.d.comb += taken.eq(1)
            m.d.sync += [pending.eq(0), *(applied[f.name].eq(held[f.name]) for f in fields)]
        # While a height is set, the core sees its frames' ends marked; without one, it must forget that.
        no_longer = applied.geometry_height.any() & ~held.geometry_height.any()
        m.d.comb += self._core.settings.forget.eq(taken & no_longer)
        return applied

    def _thresholds(self, m: Module, applied: data.View) -> None:
        """Passes thresholds from the registers to the core, limited to the range that it accepts."""
        settings, limits = self._core.settings, threshold_limits(self._config)
        for name, field in THRESHOLDS.items():
            if name in settings_layout(self._config).members:
                told: Value = applied[field]
                most = (1 << len(told)) - 1
                low, high = limits.get(name, (0, most))
                # Comparisons that never hold are left out: linters report them.
                held = Mux(told > high, high, told) if high < most else told
                m.d.comb += settings[name].eq(Mux(told < low, low, held) if low else held)

    def _give(self, m: Module, applied: data.View, frames: Frames) -> None:
        """Puts the core's results on the output stream."""
        config = self._config
        result = self._core.o.payload
        outcome = Signal(self._outcome)
        unsure = Signal()
        if config.post.confidence:
            measured = is_measured(result.code)
            m.d.comb += unsure.eq(measured & (result.confidence < applied.confidence_floor))
            m.d.comb += outcome.confidence.eq(result.confidence)
        if "left" in self._outcome.members:
            m.d.comb += outcome.left.eq(bits_of(result.left, config.pixel))
        code = Signal(UNSURE.bit_length())
        m.d.comb += code.eq(Mux(unsure, UNSURE, result.code))
        valid = is_measured(code) | (code == Validity.FILLED)
        disparity = extended(Value.cast(result.disparity), config.signed)
        m.d.comb += [
            outcome.disparity.eq(Mux(valid, disparity, applied.invalid_value)),
            outcome.code.eq(code),
            outcome.damaged.eq(result.damaged),
            self.m_axis_tdata.eq(outcome),
            self.m_axis_tvalid.eq(self._core.o.valid),
            self.m_axis_tuser.eq(result.sof),
            self.m_axis_tlast.eq(result.eol),
            self._core.o.ready.eq(self.m_axis_tready),
            frames.leaves.eq(self.m_axis_tvalid & self.m_axis_tready),
            frames.eol.eq(result.eol),
            frames.eof.eq(result.eof),
        ]


def _is_port(name: str) -> bool:
    return name.startswith(PREFIX)


def _through(m: Module, member: wiring.Member, outside: Value, inside: Value) -> None:
    """Connects a port of the whole to the same port of a part."""
    m.d.comb += inside.eq(outside) if member.flow is In else outside.eq(inside)


def _any_of(held: data.View, values: str, masks: str) -> Value:
    """Whether any field is set both in the register `values` and, by the same name, in `masks`."""
    names = [
        name.removeprefix(f"{values}_") for name in held.shape().members if name.startswith(f"{values}_")
    ]
    return Cat(held[f"{values}_{name}"] & held[f"{masks}_{name}"] for name in names).any()
