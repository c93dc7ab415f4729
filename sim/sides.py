"""The two ends of a core's streams on the bench: a source of pixel pairs and a sink of results.

Each is told about every clock twice: `sample`, with the values that the core's registers see at the
edge, then `drive`, whose writes take effect after it. Signals are written only when they change:
each write costs an evaluation of the design.
"""

from array import array
from collections.abc import Iterator
from typing import Any

from softdepth.sim.job import Job, Violation
from softdepth.sim.stalls import Pauses

MOST_VIOLATIONS = 100


class Source:
    """Offers a job's transfers in turn; an offer stays until it is taken.

    Members
    -------
    taken : the clock of each transfer so far.
    offered : whether a transfer is on offer.
    """

    def __init__(self, dut: Any, job: Job) -> None:
        self._valid, self._ready, self._payload = dut.i_valid, dut.i_ready, dut.i_payload
        self._transfers = job.transfers
        self._gaps = dict(job.gaps)
        self._gap = 0
        self._paused = _paused_clocks(job.stalls.input)
        self.taken = array("q")
        self.offered = False

    @property
    def exhausted(self) -> bool:
        """Whether every transfer has been taken."""
        return len(self.taken) == len(self._transfers)

    def silence(self) -> None:
        """Withdraw the offer, for a reset."""
        self._valid.value = 0
        self.offered = False

    def sample(self, cycle: int) -> bool:
        """Whether the core takes the offer at this edge."""
        if self.offered and self._ready.value:
            self.taken.append(cycle)
            return True
        return False

    def drive(self) -> None:
        """Unless there is an offer already, make the next one, or pause."""
        was_offered, self.offered = self.offered, not self.exhausted and not self._pauses()
        if self.offered:
            self._payload.value = int(self._transfers[len(self.taken)])
        if self.offered != was_offered:
            self._valid.value = self.offered

    def _pauses(self) -> bool:
        self._gap += self._gaps.pop(len(self.taken), 0)
        if self._gap:
            self._gap -= 1
            return True
        return self._paused is not None and next(self._paused)


class Sink:
    """Takes results, and checks that an offered result stays until it is taken.

    Members
    -------
    payloads : packed results so far, as the simulator's binary digits; since the last `hand_over`.
    cycles, epochs : the clock of each, and the value of `epoch` then.
    violations : broken rules.
    accepting : whether a result would be taken at the next edge.
    """

    def __init__(self, dut: Any, job: Job) -> None:
        self._valid, self._ready, self._payload = dut.o_valid, dut.o_ready, dut.o_payload
        self._paused = _paused_clocks(job.stalls.output)
        self._held: str | None = None
        self.payloads: list[str] = []
        self.cycles, self.epochs = array("q"), array("q")
        self.violations: list[Violation] = []
        self.accepting = False
        self.epoch = 0

    def silence(self) -> None:
        """Take nothing, for a reset, and forget what waits."""
        self._ready.value = 0
        self.accepting = False
        self._held = None

    def sample(self, cycle: int) -> bool:
        """Whether a result is taken at this edge."""
        if not self._valid.value:
            if self._held is not None:
                self._violated(cycle, "o.valid fell before o.ready took the result")
                self._held = None
            return False
        payload = str(self._payload.value)
        if self._held is not None and payload != self._held:
            self._violated(cycle, "o.payload changed while o.valid waited for o.ready")
        if not self.accepting:
            self._held = payload
            return False
        self._held = None
        self.payloads.append(payload)
        self.cycles.append(cycle)
        self.epochs.append(self.epoch)
        return True

    def hand_over(self) -> list[str]:
        """The results since the last call; they are no longer kept."""
        given, self.payloads = self.payloads, []
        return given

    def drive(self) -> None:
        """Accept, or pause."""
        accepting = self._paused is None or not next(self._paused)
        if accepting != self.accepting:
            self.accepting = accepting
            self._ready.value = accepting

    def _violated(self, cycle: int, rule: str) -> None:
        if len(self.violations) < MOST_VIOLATIONS:
            self.violations.append(Violation(cycle, rule))


def _paused_clocks(pauses: Pauses) -> Iterator[bool] | None:
    """None where there are none: asking at each clock would cost time."""
    return None if pauses.mode == "none" and not pauses.initial else pauses.clocks()
