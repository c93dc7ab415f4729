"""Pixel pairs in, well-formed frames of what is compared out: the first room."""

from amaranth.hdl import Module, ResetSignal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.front.descriptors import Descriptors
from softdepth.hdl.front.frame_ends import FrameEnds
from softdepth.hdl.front.frame_guard import FrameGuard, item_layout
from softdepth.hdl.front.overlap import Overlap
from softdepth.hdl.memory.item_queue import ItemQueue, places_for
from softdepth.hdl.memory.kept import Kept
from softdepth.hdl.signatures import STEERING, Faults, Status, pair_layout
from softdepth.spec.config import Config


class Front(wiring.Component):
    """Mends frames and computes each view's descriptors.

    ::

        i > frame guard > queue > (frame ends > overlap > descriptors) > o

    Windows of pixels are compared as they are; criteria that need descriptors get them, with the frame's
    edges repeated, and those of the views' overlap where candidates do not begin at 0. It takes a pixel a
    clock, or one every `Config.steps` clocks where that is how fast the room behind takes them; repeats hold
    the input back. During reset no pixel is taken: ``i.ready`` is low.

    Parameters
    ----------
    descriptors : what pixels are compared by; without them, their windows are compared as they are.
    left : items whose left pixel is kept behind the guard; 0 keeps none.

    Members
    -------
    places : items that wait here where the room behind is busy.
    i : stream of `pair_layout(config.pixel)`.
    o : stream of `layout`: `item_layout` of windows of pixels, or the raster of `Descriptors`.
    kept : with ``left``, a stream of the left pixels of well-formed frames, one for each result to come.
    hold, skip, clear, forget, faults, status : as of `FrameGuard`.
    """

    latency = ItemQueue.latency
    """Clocks from a pair to its item."""
    to_descriptors = ItemQueue.latency + FrameEnds.latency + ItemQueue.latency
    """Clocks from a pair to the descriptors' input."""

    def __init__(self, config: Config, descriptors: Descriptors | None = None, *, left: int = 0) -> None:
        self._config, self._left = config, left
        self._descriptors = descriptors
        self.places = places_for(1 if descriptors else config.steps)
        self.layout: data.StructLayout = descriptors.layout if descriptors else item_layout(config)
        super().__init__(
            {
                "i": In(stream.Signature(pair_layout(config.pixel))),
                "o": Out(stream.Signature(self.layout)),
                **({"kept": Out(stream.Signature(config.pixel.size))} if left else {}),
                **{name: In(1) for name in STEERING},
                "faults": Out(Faults),
                "status": Out(Status),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config = self._config
        m.submodules.guard = guard = FrameGuard(config)
        m.submodules.queue = queue = ItemQueue(item_layout(config), places=self.places)
        m.d.comb += [
            guard.i.valid.eq(self.i.valid),
            guard.i.payload.eq(self.i.payload),
            self.i.ready.eq(guard.i.ready & ~ResetSignal("sync")),
            self.status.eq(guard.status),
            self.faults.eq(guard.faults),
            *(getattr(guard, name).eq(getattr(self, name)) for name in STEERING),
        ]
        items = guard.o
        if self._left:
            m.submodules.left = left = Kept(item_layout(config), "left", self._left)
            wiring.connect(m, items, left.i)
            wiring.connect(m, left.kept, wiring.flipped(self.kept))
            items = left.o
        wiring.connect(m, items, queue.i)
        if self._descriptors is None:
            wiring.connect(m, queue.o, wiring.flipped(self.o))
            return m
        m.submodules.ends = ends = FrameEnds(config)
        m.submodules.descriptors = self._descriptors
        wiring.connect(m, queue.o, ends.i)
        pairs = ends.o
        if config.min_disparity:
            m.submodules.overlap = overlap = Overlap(config)
            wiring.connect(m, pairs, overlap.i)
            pairs = overlap.o
        # The window decides late in its clock, and that reaches no further than this.
        m.submodules.pairs = places = ItemQueue(pairs.payload.shape())
        wiring.connect(m, pairs, places.i)
        wiring.connect(m, places.o, self._descriptors.i)
        wiring.connect(m, self._descriptors.o, wiring.flipped(self.o))
        return m
