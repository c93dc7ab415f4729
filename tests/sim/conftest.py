"""A small design with the core's ports, and versions of it that break the stream rules.

It lets the bench be tested in seconds, and shows that the bench's checks can fail.
"""

from collections.abc import Callable
from typing import Literal

import numpy as np
import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.fifo import SyncFIFOBuffered
from amaranth.lib.stream import Signature
from amaranth.lib.wiring import In, Out

from softdepth.hdl.signatures import Status, pair_layout, result_layout
from softdepth.hdl.verilog import to_verilog
from softdepth.spec.config import Config, PixelFormat

Fault = Literal["none", "drops_valid", "changes_payload", "loses_last", "repeats_last", "hangs"]

FIFO_DEPTH = 8
FAULT_COUNT = 20
"""The faults strike from this transfer on."""


class StandIn(wiring.Component):
    """Gives each pixel pair ``(left - right) mod disparities``, `steps` clocks a pixel, markers passed on.

    ``status.short_lines`` counts the lines taken since reset. Faults: ``drops_valid`` takes back an offer
    that was not accepted, ``changes_payload`` alters one, ``loses_last`` and ``repeats_last`` give one
    result too few or too many at an end of frame, ``hangs`` stops taking pixels.
    """

    def __init__(self, config: Config, fault: Fault = "none") -> None:
        self.config = config
        self.fault = fault
        super().__init__(
            {
                "i": In(Signature(pair_layout(PixelFormat.RGB8))),
                "o": Out(Signature(result_layout(config))),
                "status": Out(Status),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.fifo = fifo = SyncFIFOBuffered(width=self.o.payload.shape().size, depth=FIFO_DEPTH)
        step = Signal(range(max(self.config.steps, 2)))
        taken = Signal(range(FAULT_COUNT + 1))
        result = Signal(result_layout(self.config))
        ready = fifo.w_rdy & (step == 0)
        if self.fault == "hangs":
            ready &= taken != FAULT_COUNT
        m.d.comb += [
            self.i.ready.eq(ready),
            result.disparity.eq(self.i.payload.left - self.i.payload.right),
            result.sof.eq(self.i.payload.sof),
            result.eol.eq(self.i.payload.eol),
            result.eof.eq(self.i.payload.eof),
            fifo.w_data.eq(result),
            fifo.w_en.eq(self.i.valid & ready),
            self.o.valid.eq(fifo.r_rdy),
            self.o.payload.eq(fifo.r_data),
            fifo.r_en.eq(self.o.ready & self.o.valid),
        ]
        with m.If(self.i.valid & ready):
            m.d.sync += step.eq(self.config.steps - 1)
            m.d.sync += taken.eq(taken + (taken != FAULT_COUNT))
            m.d.sync += self.status.short_lines.eq(self.status.short_lines + self.i.payload.eol)
        with m.Elif(step != 0):
            m.d.sync += step.eq(step - 1)
        self._break(m, fifo, taken)
        return m

    def _break(self, m: Module, fifo: SyncFIFOBuffered, taken: Signal) -> None:
        struck = taken == FAULT_COUNT
        waited = Signal()
        m.d.sync += waited.eq(fifo.r_rdy & ~self.o.ready)
        if self.fault == "drops_valid":
            m.d.comb += self.o.valid.eq(fifo.r_rdy & ~(struck & waited))
        elif self.fault == "changes_payload":
            m.d.comb += self.o.payload.disparity.eq(
                result_layout(self.config)(fifo.r_data).disparity ^ (struck & waited)
            )
        elif self.fault == "loses_last":
            m.d.comb += fifo.w_en.eq(self.i.valid & self.i.ready & ~self.i.payload.eof)
        elif self.fault == "repeats_last":
            again = Signal()
            m.d.sync += again.eq(self.i.valid & self.i.ready & self.i.payload.eof)
            with m.If(again):
                m.d.comb += [self.i.ready.eq(0), fifo.w_en.eq(1)]


def expected_disparities(config: Config, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """What the stand-in computes, from uint8 images: only red reaches the low bits of a pixel."""
    return (left[..., 0].astype(int) - right[..., 0]) % config.disparities


@pytest.fixture
def config() -> Config:
    """Two clocks a pixel."""
    return Config.from_dict({"disparities": 32, "lanes": 16, "max_width": 64, "max_height": 64})


@pytest.fixture
def stand_in(config: Config) -> Callable[..., str]:
    """Verilog of the stand-in for `config`, with a fault by name."""
    return lambda fault="none": to_verilog(StandIn(config, fault))


@pytest.fixture
def pair() -> tuple[np.ndarray, np.ndarray]:
    """A 9x12 uint8 RGB pair without any symmetry."""
    left, right = np.random.default_rng(7).integers(0, 256, (2, 9, 12, 3), dtype=np.uint8)
    return left, right


@pytest.fixture
def model() -> Callable[..., np.ndarray]:
    """What the stand-in computes."""
    return expected_disparities
