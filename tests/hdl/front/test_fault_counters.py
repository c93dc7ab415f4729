"""FaultCounters: each fault in its own counter, which stops at its greatest value."""

from softdepth.hdl.front.fault_counters import FaultCounters
from softdepth.hdl.signatures import COUNTER_BITS, Status
from tests.support.simulation import Ports, observe

NAMES = tuple(Status.members)


def counts(clocks: list[Ports]) -> list[dict[str, int]]:
    """The counters after each clock's reports have arrived."""
    idle: list[Ports] = [dict.fromkeys(NAMES, 0)] * FaultCounters.latency
    bits = observe(FaultCounters(), [*clocks, *idle], "status")[FaultCounters.latency :]
    views = [Status.from_bits(word) for word in bits]
    return [{name: int(view[name]) for name in NAMES} for view in views]


def test_each_fault_in_its_counter() -> None:
    met = [(0,), (1,), (1, 2), (), (0, 1, 2, 3), (3,), (3,)]
    clocks: list[Ports] = [{name: k in faults for k, name in enumerate(NAMES)} for faults in met]
    for n, found in enumerate(counts(clocks)):
        assert found == {name: sum(k in faults for faults in met[: n + 1]) for k, name in enumerate(NAMES)}


def test_what_comes_again_is_counted_once() -> None:
    met = [(1, 1), (1, 1), (1, 0), (0, 0), (0, 1), (1, 0), (1, 0)]
    clocks: list[Ports] = [{NAMES[2]: report, "again": again} for report, again in met]
    clocks.append({NAMES[2]: 0, "again": 0})
    found = [each[NAMES[2]] for each in counts(clocks)]
    assert found[:7] == [0, 0, 1, 1, 1, 2, 3]


def test_counters_count_one_by_one_to_their_greatest_value_and_stop() -> None:
    most = 2**COUNTER_BITS - 1
    clocks: list[Ports] = [dict.fromkeys(NAMES, 1)] * (most + 3)
    for n, found in enumerate(counts(clocks)):
        assert found == dict.fromkeys(NAMES, min(n + 1, most))
