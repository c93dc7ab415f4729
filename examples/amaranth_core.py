"""A core in an Amaranth design, simulated: prints a # for each pixel where something is near."""

from amaranth.hdl import Module, Signal
from amaranth.sim import Simulator

from softdepth.golden.data import synthetic
from softdepth.hdl import StereoCore
from softdepth.sim.transfers import pack_frame
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity

CONFIG = Config.preset("sad").override(["disparities=8", "lanes=4", "max_width=64", "max_height=32"])
SCENE = synthetic.generate("steps", width=48, height=16, disparities=8)

m = Module()
m.submodules.core = core = StereoCore(CONFIG)
result, near = core.o.payload, Signal()
m.d.comb += near.eq((result.code < Validity.BORDER) & (result.disparity >= 4))
m.d.comb += core.o.ready.eq(1)


async def send(ctx):
    ctx.set(core.i.valid, 1)
    for pixel in pack_frame(SCENE.left, SCENE.right).tolist():
        ctx.set(core.i.payload.as_value(), pixel)
        await ctx.tick().until(core.i.ready)
    ctx.set(core.i.valid, 0)


async def show(ctx):
    for _ in range(SCENE.height):
        line = [(await ctx.tick().sample(near).until(core.o.valid))[0] for _ in range(SCENE.width)]
        print("".join(".#"[each] for each in line))


simulator = Simulator(m)
simulator.add_clock(1e-8)
simulator.add_testbench(send, background=True)
simulator.add_testbench(show)
simulator.run()
