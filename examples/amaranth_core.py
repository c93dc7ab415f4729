"""A core in an Amaranth design: a stream of pixel pairs in, and for each whether something is near there."""

from amaranth.hdl import Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import Out, connect, flipped
from amaranth.sim import Simulator

from softdepth.golden.data import synthetic
from softdepth.hdl import StereoCore
from softdepth.sim.transfers import pack_frame
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity

CONFIG = Config.preset("sad").override(["disparities=8", "lanes=4", "max_width=64", "max_height=32"])


class Near(wiring.Component):
    """Takes what `StereoCore` takes; gives 1 for a measured disparity of at least `least` pixels."""

    def __init__(self, least):
        self.core, self.least = StereoCore(CONFIG), least
        super().__init__({"i": self.core.signature.members["i"], "o": Out(stream.Signature(1))})

    def elaborate(self, platform):
        m = Module()
        m.submodules.core = core = self.core
        connect(m, flipped(self.i), core.i)
        result = core.o.payload
        m.d.comb += self.o.payload.eq((result.code < Validity.BORDER) & (result.disparity >= self.least))
        m.d.comb += [self.o.valid.eq(core.o.valid), core.o.ready.eq(self.o.ready)]
        return m


def main():
    """Simulate a frame and print it."""
    scene = synthetic.generate("steps", width=48, height=16, disparities=8)
    dut = Near(least=4)

    async def send(ctx):
        ctx.set(dut.i.valid, 1)
        for pixel in pack_frame(scene.left, scene.right).tolist():
            ctx.set(dut.i.payload.as_value(), pixel)
            await ctx.tick().until(dut.i.ready)
        ctx.set(dut.i.valid, 0)

    async def show(ctx):
        ctx.set(dut.o.ready, 1)
        for _ in range(scene.height):
            line = [
                (await ctx.tick().sample(dut.o.payload).until(dut.o.valid))[0] for _ in range(scene.width)
            ]
            print("".join(".#"[near] for near in line))

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(send, background=True)
    simulator.add_testbench(show)
    simulator.run()


if __name__ == "__main__":
    main()
