"""The whole evaluation, from data set to files."""

import json
from collections.abc import Sequence
from pathlib import Path

from softdepth import screen
from softdepth.files import write_atomically
from softdepth.spec.errors import InputError
from softdepth.studies.paper import cache, html, pages, scenes, speed, work
from softdepth.studies.paper.cache import MapCache
from softdepth.studies.paper.document import Document
from softdepth.studies.paper.margins import Margins
from softdepth.studies.paper.published import SCENES
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.speed import Speeds
from softdepth.studies.paper.work import Maps

FILES = ("paper.md", "paper.html", "paper.json")


def check_data(reading: Reading) -> None:
    """Raise `InputError` unless all three scenes are there: before anything takes its time."""
    for name in SCENES:
        scenes.load(name, reading.size)


def maps_of(reading: Reading, maps_cache: MapCache, jobs: int, simulated: Sequence[work.Cell] = ()) -> Maps:
    """Every map, showing progress: the `simulated` cells first, a missing tool then shows at once."""
    maps: Maps = {}
    for number, cell in enumerate(simulated, start=1):
        scene = scenes.load(cell.scene, cell.reading.size)
        extended = Margins.of(cell.reading, cell.config).extend(scene.left)
        title = f"gateware {number} of {len(simulated)}: {cell.scene} {cell.operator or 'sad'}"
        with screen.progress(title, extended.shape[0] * extended.shape[1]) as advance:
            maps[cell] = work.simulate(cell, maps_cache, advance)
    cells = work.models(reading)
    with screen.progress("maps of the models", work.pixels(cells)) as advance:
        maps |= work.run(cells, maps_cache, jobs, advance)
    return maps


def speeds_of(reading: Reading, place: Path | None) -> Speeds:
    """The operators' speed, measured alone on the machine, or as measured before."""
    scene = scenes.load(SCENES[0], reading.size)
    facts = {
        "reading": reading.plain(),
        "images": scene.digest,
        "source": cache.source_version(),
        "processor": speed.processor(),
        "measure": [speed.ROWS, speed.REPEATS, speed.LANES],
    }
    path = None if place is None else place / f"speed-{cache.digest(facts)}.json"
    if path is not None and path.exists():
        try:
            return Speeds.model_validate_json(path.read_text())
        except (OSError, ValueError):
            pass  # damaged: measured again
    screen.note("speed of the operators ...")
    found = speed.measure(scene, reading)
    if path is not None:
        cache.make_folder(path.parent)
        write_atomically(path, found.model_dump_json().encode())
    return found


def write(folder: Path, document: Document, maps: Maps, reading: Reading) -> None:
    """Write `FILES` into `folder`."""
    title = "# The paper's evaluation, regenerated\n\n"
    (folder / "paper.md").write_text(title + pages.markdown(document) + "\n")
    (folder / "paper.html").write_text(html.page(document, maps, reading))
    (folder / "paper.json").write_text(json.dumps(document.model_dump(), indent=2) + "\n")


def renew(path: Path, document: Document) -> None:
    """Put the tables between the markers of a Markdown document.

    Raises `InputError` if the document or its markers are missing.
    """
    from softdepth.studies import markers

    try:
        text = path.read_text()
    except OSError as error:
        raise InputError(f"cannot read '{path}' ({error.strerror})", "name the document to renew") from error
    renewed = markers.renew(text, path.name, "paper", pages.markdown(document, level=3))
    write_atomically(path, renewed.encode())
