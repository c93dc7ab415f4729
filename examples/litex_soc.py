"""A LiteX SoC around a core that ``softdepth export --ip axi`` has written.

    python examples/litex_soc.py DIR NAME -o build

A host masters the SoC's bus from pins, and the streams are pins: put a processor, a camera and a memory in
their places. The core's registers are a region of the bus, its interrupt is an event with CSRs, and LiteX
writes both down in ``csr.json``. Nothing is built: out comes Verilog, for a simulator or an FPGA's flow.
"""

import argparse
import importlib.util
from pathlib import Path

from litex.build.generic_platform import Pins, Subsignal
from litex.build.lattice import LatticePlatform
from litex.gen import LiteXModule
from litex.soc.integration.builder import Builder
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCMini
from litex.soc.interconnect import axi, stream
from migen import ClockDomain

PART, CLOCK_HZ = "LFE5U-85F-6BG381C", 100e6
ORIGIN = 0x3000_0000
"""Of the core's registers: LiteX's own lie at 0 where there is no processor."""


def module_of(folder, name):
    """The class that the package's LiteX module defines."""
    spec = importlib.util.spec_from_file_location(
        f"{name}_litex", Path(folder).resolve() / f"{name}_litex.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return next(each for each in vars(module).values() if isinstance(each, type) and hasattr(each, "SIZE"))


def stream_pins(name, bits):
    """A stream as AXI4-Stream names its signals."""
    signals = {"tdata": bits, "tvalid": 1, "tready": 1, "tuser": 1, "tlast": 1}
    return (name, 0, *(Subsignal(signal, Pins(width)) for signal, width in signals.items()))


class Clock(LiteXModule):
    """The clock domain ``sys``, of pins."""

    def __init__(self, clock, reset):
        self.cd_sys = ClockDomain()
        self.comb += [self.cd_sys.clk.eq(clock), self.cd_sys.rst.eq(reset)]


class DepthSoC(SoCMini):
    """The SoC: a bus with a master and the core, and the core's streams."""

    def __init__(self, platform, core):
        self.crg = Clock(platform.request("clock"), platform.request("reset"))
        SoCMini.__init__(self, platform, clk_freq=CLOCK_HZ, bus_standard="axi-lite")

        host = axi.AXILiteInterface()
        platform.add_extension(host.get_ios("host"))
        self.comb += host.connect_to_pads(platform.request("host"), mode="slave")
        self.bus.add_master("host", host)

        self.depth = core(platform)
        self.bus.add_slave("depth", self.depth.bus, SoCRegion(ORIGIN, core.SIZE, cached=False))
        self.comb += platform.request("irq").eq(self.depth.ev.irq)

        streams = {name: each for name, each in vars(self.depth).items() if isinstance(each, stream.Endpoint)}
        for name, endpoint in streams.items():
            platform.add_extension([stream_pins(name, len(endpoint.data))])
            pads = platform.request(name)
            pairs = [(pads.tdata, endpoint.data), (pads.tuser, endpoint.sof), (pads.tlast, endpoint.last)]
            pairs += [(pads.tvalid, endpoint.valid), (endpoint.ready, pads.tready)]
            if name.startswith("m_"):
                self.comb += [outside.eq(inside) for outside, inside in pairs]
            else:
                self.comb += [inside.eq(outside) for outside, inside in pairs]


def main():
    """Write the SoC's Verilog and the map of its addresses."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", help="what softdepth export --ip axi has written")
    parser.add_argument("name", help="the core's module")
    parser.add_argument("-o", "--output", default="build", help="gets gateware/soc.v and csr.json")
    chosen = parser.parse_args()
    pins = [(name, 0, Pins(1)) for name in ("clock", "reset", "irq")]
    soc = DepthSoC(LatticePlatform(PART, pins, toolchain="trellis"), module_of(chosen.folder, chosen.name))
    output = Path(chosen.output)
    builder = Builder(soc, output_dir=output, compile_gateware=False, csr_json=output / "csr.json")
    builder.build(build_name="soc")


if __name__ == "__main__":
    main()
