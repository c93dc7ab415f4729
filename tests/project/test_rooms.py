"""Frames walk through four rooms, and none knows those that come after it."""

import pytest

from tests.support.imports import graph

ROOMS = ("front", "costs", "winners", "post")
"""In the data's order."""
SHARED = {"softdepth.hdl": ("arithmetic", "memory"), "softdepth.golden": ()}
"""What all four use, which knows none of them."""


def order_of(module: str, top: str) -> int | None:
    """Which room a module is in, from 0; -1 for what they share, and None elsewhere."""
    inner = module.removeprefix(f"{top}.").partition(".")[0]
    if not module.startswith(f"{top}.") or inner not in (*ROOMS, *SHARED[top]):
        return None
    return ROOMS.index(inner) if inner in ROOMS else -1


def backward(edges: dict[str, set[str]], top: str) -> list[str]:
    """Imports of a later room by an earlier one."""
    return [
        f"{module} imports {each}"
        for module, targets in edges.items()
        for each in sorted(targets)
        if (here := order_of(module, top)) is not None and (there := order_of(each, top)) is not None
        if there > here
    ]


@pytest.mark.parametrize("top", SHARED)
def test_no_room_knows_a_later_one(top: str) -> None:
    edges = graph(types=True)
    assert {order_of(module, top) for module in edges} >= {0, 1, 2, 3}
    assert backward(edges, top) == []


@pytest.mark.parametrize(
    ("module", "imported"),
    [
        ("softdepth.hdl.front.front", "softdepth.hdl.costs.comparison"),
        ("softdepth.hdl.winners.number", "softdepth.hdl.post.stages"),
        ("softdepth.hdl.memory.delay", "softdepth.hdl.front.front"),
        ("softdepth.golden.winners.frame", "softdepth.golden.post.maps"),
    ],
)
def test_a_way_back_is_found(module: str, imported: str) -> None:
    edges = graph()
    assert {module, imported} <= edges.keys()
    edges[module] = {*edges[module], imported}
    assert backward(edges, ".".join(module.split(".")[:2])) == [f"{module} imports {imported}"]
