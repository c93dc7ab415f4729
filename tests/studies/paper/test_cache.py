"""The cache: the same question is answered from it, any other is not."""

import shutil
from dataclasses import replace

import numpy as np
import pytest

from softdepth import sources
from softdepth.spec.errors import InputError
from softdepth.studies.paper import cache, readings, work
from softdepth.studies.paper.cache import MapCache, key
from softdepth.studies.paper.cells import Cell, Found

CELL = Cell("teddy", readings.NEST_357, "mean", "float")
FOUND = Found(np.arange(12, dtype=np.uint16).reshape(3, 4), np.eye(3, 4, dtype=bool), 1.5)


def test_a_map_comes_back(tmp_path):
    store = MapCache(tmp_path / "new" / "paper")
    assert store.get(CELL, "images") is None
    store.put(CELL, "images", FOUND)
    found = store.get(CELL, "images")
    assert found is not None
    np.testing.assert_array_equal(found.disparity, FOUND.disparity)
    np.testing.assert_array_equal(found.valid, FOUND.valid)
    assert (found.disparity.dtype, found.seconds) == (np.uint16, 1.5)


@pytest.mark.parametrize(
    "other",
    [
        replace(CELL, operator="min"),
        replace(CELL, engine="fixed"),
        replace(CELL, rule="top"),
        replace(CELL, rule="top", judge=3),
        replace(CELL, reading=replace(CELL.reading, windows=(3, 5, 9))),
        replace(CELL, reading=replace(CELL.reading, candidates=32)),
        replace(CELL, reading=replace(CELL.reading, leaving="excluded")),
        replace(CELL, reading=replace(CELL.reading, view="left")),
        replace(CELL, reading=replace(CELL.reading, label=4096.0)),
        replace(CELL, reading=replace(CELL.reading, blank=1)),
    ],
    ids=lambda cell: f"{cell.operator}-{cell.engine}-{cell.rule}-{cell.reading.windows}-{cell.judge}",
)
def test_another_question_is_another_key(tmp_path, other):
    store = MapCache(tmp_path)
    store.put(CELL, "images", FOUND)
    assert store.get(other, "images") is None
    assert store.get(CELL, "images of another scene") is None
    assert key(other, "images") != key(replace(other, operator="prod"), "images")


def test_how_a_map_is_drawn_or_scored_does_not_change_it():
    same = replace(CELL.reading, name="another", why="", first=7, truth="left")
    assert key(replace(CELL, reading=same), "images") == key(CELL, "images")


def test_changed_sources_invalidate(tmp_path, monkeypatch):
    """An edit in the specification is enough: what the criteria are decides every map."""
    store = MapCache(tmp_path)
    store.put(CELL, "images", FOUND)
    edited = tmp_path / "spec"
    shutil.copytree(sources.folder("spec"), edited)
    with (edited / "criteria.py").open("a") as file:
        file.write("# edited\n")
    folder = sources.folder
    monkeypatch.setattr(sources, "folder", lambda room: edited if room == "spec" else folder(room))
    assert store.get(CELL, "images") is None


def test_the_gateware_has_more_sources():
    assert cache.source_version(True) != cache.source_version(False)
    assert key(replace(CELL, engine="rtl"), "i") != key(replace(CELL, engine="fixed"), "i")


@pytest.mark.parametrize("damage", ["cut", "empty", "text"])
def test_a_damaged_file_counts_as_none(tmp_path, damage):
    store = MapCache(tmp_path)
    store.put(CELL, "images", FOUND)
    (file,) = tmp_path.iterdir()
    data = file.read_bytes()
    file.write_bytes({"cut": data[: len(data) // 2], "empty": b"", "text": b"nothing of the kind"}[damage])
    assert store.get(CELL, "images") is None
    store.put(CELL, "images", FOUND)
    assert store.get(CELL, "images") is not None


def test_without_a_folder_nothing_is_kept():
    store = MapCache(None)
    store.put(CELL, "images", FOUND)
    assert store.get(CELL, "images") is None


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match=r"cannot make the cache .*--no-cache"):
        MapCache(tmp_path / "file" / "paper").put(CELL, "images", FOUND)


def test_place(monkeypatch, tmp_path):
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path))
    assert cache.folder() == tmp_path / "paper"
    monkeypatch.delenv("SOFTDEPTH_CACHE")
    assert cache.folder().parts[-2:] == ("softdepth", "paper")


def test_work_computes_each_map_once(tiny, tmp_path, monkeypatch):
    computed: list[Cell] = []
    compute = work.compute
    monkeypatch.setattr(work, "compute", lambda cell, scene: computed.append(cell) or compute(cell, scene))
    small = replace(readings.NEST_357, candidates=8)
    cells = [Cell(scene, small, "mean", "float") for scene in ("teddy", "cones")]
    heard: list[int] = []
    first = work.run(cells, MapCache(tmp_path), 1, heard.append)
    assert computed == cells
    assert heard[-1] == work.pixels(cells)
    second = work.run([*cells, replace(cells[0], engine="fixed")], MapCache(tmp_path), 1)
    assert computed == [*cells, replace(cells[0], engine="fixed")]
    for cell in cells:
        np.testing.assert_array_equal(first[cell].disparity, second[cell].disparity)
