"""``softdepth presets`` and ``softdepth datasets``: the names that other commands take."""

from rich.table import Table

from softdepth import screen
from softdepth.spec.config import PRESETS, Config


def presets() -> None:
    """List the built-in configurations."""
    table = Table("preset", "cost", "criteria", "disparities", "lanes", "clocks/pixel", "hash", box=None)
    for column in (table.columns[0], table.columns[-1]):
        column.no_wrap = True
    for name in PRESETS:
        config = Config.preset(name)
        criteria = ", ".join(map(str, config.criteria))
        numbers = map(str, (config.disparities, config.lanes, config.steps))
        table.add_row(name, config.cost, criteria, *numbers, config.hash)
    screen.console().print(table)


def datasets() -> None:
    """List the stereo pairs with known depth, and where they come from."""
    from softdepth.golden.data import datasets

    for name in datasets.names():
        print(name)
