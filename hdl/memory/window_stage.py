"""A window between two streams."""

from collections.abc import Mapping

from amaranth.hdl import Module, Value
from amaranth.lib.wiring import PureInterface

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.delay import delayed
from softdepth.hdl.memory.result_queue import ResultQueue
from softdepth.hdl.memory.window import MARKERS, Window


def window_stage(
    m: Module,
    i: PureInterface,
    o: PureInterface,
    window: Window,
    latency: int,
    *,
    element: Value,
    companion: Value,
    results: Mapping[str, Value],
) -> None:
    """Puts a window, and what is computed from it, between two streams.

    Parameters
    ----------
    window : a `Window`, or a component with its ports.
    i, o : the streams; both have the markers.
    latency : clocks from the window to ``results``.
    element, companion : of the input's payload.
    results : the output's payload without its markers, ``latency`` clocks after the window.
    """
    m.submodules.window = window
    payload = i.payload
    layout = o.payload.shape()
    m.submodules.queue = queue = ResultQueue(layout, -(-(window.latency + latency) // window.clocks))
    m.d.comb += [
        window.i.valid.eq(i.valid),
        i.ready.eq(window.i.ready),
        Value.cast(window.i.payload.element).eq(element),
        Value.cast(window.i.payload.companion).eq(companion),
        *(window.i.payload[name].eq(payload[name]) for name in MARKERS),
        window.credit.eq(queue.credit),
        queue.promised.eq(window.promised),
        queue.put.eq(travelling(m, window.valid, latency, "put")[-1]),
        *(queue.result[name].eq(delayed(m, getattr(window, name), latency, name)) for name in MARKERS),
        *(Value.cast(queue.result[name]).eq(value) for name, value in results.items()),
        o.valid.eq(queue.o.valid),
        queue.o.ready.eq(o.ready),
        o.payload.eq(queue.o.payload),
    ]
