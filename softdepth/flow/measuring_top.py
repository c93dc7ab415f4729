"""A core without pins: its ports on shift registers, so that nothing but the core is measured."""

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.core import StereoCore
from softdepth.spec.config import Config


class MeasuringTop(wiring.Component):
    """`StereoCore` between a shift register that feeds its inputs and one that reads its outputs.

    Every input comes from a flip-flop and every output goes to one, so that the reported clock is the
    core's own, and nothing can be optimised away. Around the core this takes `flip_flops` and
    `lut4` (a multiplexer before each bit of the second shift register).

    Members
    -------
    serial_in : becomes the core's inputs, a bit a clock.
    load : take the core's outputs as they are; else shift them.
    serial_out : the outputs, a bit a clock.
    inputs, outputs : the core's ports, in the order of the shift registers.
    """

    def __init__(self, config: Config) -> None:
        self._core = StereoCore(config)
        core = self._core
        self.inputs = Cat(core.i.payload.as_value(), core.i.valid, core.o.ready)
        self.outputs = Cat(core.o.payload.as_value(), core.o.valid, core.i.ready, core.status.as_value())
        self.lut4 = len(self.outputs) - 1
        self.flip_flops = len(self.inputs) + 2 * len(self.outputs)
        super().__init__({"serial_in": In(1), "load": In(1), "serial_out": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.core = self._core
        feed = Signal(len(self.inputs), reset_less=True)
        seen = Signal(len(self.outputs), reset_less=True)
        out = Signal(len(self.outputs), reset_less=True)
        m.d.sync += [
            feed.eq(Cat(self.serial_in, feed)),
            seen.eq(self.outputs),
            out.eq(Cat(out[1:], 0)),
        ]
        with m.If(self.load):
            m.d.sync += out.eq(seen)
        m.d.comb += [self.inputs.eq(feed), self.serial_out.eq(out[0])]
        return m
