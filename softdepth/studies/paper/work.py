"""Which maps the evaluation needs, and computing them: on all cores, each once, from the cache if it can."""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import as_completed

from softdepth.processes import workers
from softdepth.spec.config import OPERATORS
from softdepth.studies.paper import readings, scenes
from softdepth.studies.paper.cache import MapCache
from softdepth.studies.paper.cells import Cell, Found, compute
from softdepth.studies.paper.published import SCENES
from softdepth.studies.paper.readings import Reading

Maps = dict[Cell, Found]

RULE_SCENE, RULE_OPERATOR = "teddy", "soft_min_1"
"""Figs. 4 and 5 show the compensating rule on this scene and operator."""


def models(reading: Reading) -> list[Cell]:
    """Every map that the evaluation needs besides the gateware's; `reading` is that of the FMCDM rows."""
    both = ("float", "fixed")
    cells = [Cell(scene, readings.SAD, None, engine) for scene in SCENES for engine in both]
    cells += [Cell(s, reading, o, e) for s in SCENES for o in OPERATORS for e in both]
    for window in (3, max(reading.windows)):
        plain = readings.one_view(reading, window)
        cells += [Cell(scene, plain, None, engine) for scene in SCENES for engine in both]
    for other in readings.FMCDM.values():
        cells += [Cell(s, other, o, "float") for s in SCENES for o in OPERATORS if other != reading]
    cells += [Cell(s, readings.PROTOTYPE, o, "float") for s in SCENES for o in OPERATORS]
    for method in readings.MATCHERS:
        cells += [Cell(s, readings.matcher(reading, method), None, "float") for s in SCENES]
    cells += rule_cells(reading)
    return list(dict.fromkeys(cells))


def rule_cells(reading: Reading) -> list[Cell]:
    """Maps with the compensating rule, judged by the smallest window and by the largest."""
    judges = (1, len(reading.windows))
    return [Cell(RULE_SCENE, reading, RULE_OPERATOR, "float", "top", judge) for judge in judges]


def gateware(reading: Reading, scene_names: Sequence[str], operators: Sequence[str]) -> list[Cell]:
    """The cells of Table 2 that go through the simulated gateware: SAD is an operator named ``sad``."""
    cells: list[Cell] = []
    for scene in scene_names:
        if "sad" in operators:
            cells.append(Cell(scene, readings.SAD, None, "rtl"))
        cells += [Cell(scene, reading, o, "rtl") for o in OPERATORS if o in operators]
    return cells


def run(
    cells: Iterable[Cell], cache: MapCache, jobs: int, advance: Callable[[int], None] = lambda done: None
) -> Maps:
    """The maps of `cells`, computed by `jobs` processes; `advance` hears of `pixels` done.

    Raises what a model raises, and `ToolError` when a process dies.
    """
    cells = list(cells)
    maps: Maps = {}
    missing = []
    done = 0
    for cell in cells:
        found = cache.get(cell, scenes.load(cell.scene, cell.reading.size).digest)
        if found is None:
            missing.append(cell)
        else:
            maps[cell] = found
            done += found.disparity.size
    advance(done)
    for cell, found in _computed(sorted(missing, key=_effort, reverse=True), min(jobs, len(missing))):
        cache.put(cell, scenes.load(cell.scene, cell.reading.size).digest, found)
        maps[cell] = found
        done += found.disparity.size
        advance(done)
    return {cell: maps[cell] for cell in cells}


def pixels(cells: Iterable[Cell]) -> int:
    """Pixels of all maps of `cells`."""
    sizes = (scenes.load(cell.scene, cell.reading.size).left.shape for cell in cells)
    return sum(height * width for height, width, _ in sizes)


def simulate(cell: Cell, cache: MapCache, advance: Callable[[int], None]) -> Found:
    """The map of a gateware cell; `advance` hears of pixels."""
    scene = scenes.load(cell.scene, cell.reading.size)
    found = cache.get(cell, scene.digest)
    if found is None:
        found = compute(cell, scene, advance)
        cache.put(cell, scene.digest, found)
    return found


def _computed(cells: list[Cell], jobs: int) -> Iterable[tuple[Cell, Found]]:
    if jobs <= 1:
        yield from ((cell, _compute(cell)) for cell in cells)
        return
    with workers(jobs, "--jobs") as pool:
        futures = {pool.submit(_compute, cell): cell for cell in cells}
        for future in as_completed(futures):
            yield futures[future], future.result()


def _compute(cell: Cell) -> Found:
    return compute(cell, scenes.load(cell.scene, cell.reading.size))


def _effort(cell: Cell) -> int:
    """Longest first, so that no core idles at the end."""
    rank = {"soft_min_2": 3, "soft_min_1": 2, "min": 1}.get(cell.operator or "", 0)
    return rank * 2 + (cell.engine == "float")
