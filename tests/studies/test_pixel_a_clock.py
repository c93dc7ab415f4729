"""The table of a core that takes one clock a pixel: how blocks become rooms, and that the document has it."""

import pytest

from softdepth.flow.blocks import Block
from softdepth.spec.errors import InputError
from softdepth.studies import pixel_a_clock
from softdepth.studies.pixel_a_clock import DOCUMENT, FIGURES, Study, page, rooms_of


def test_every_block_is_in_one_room():
    names = {
        "front": ("core.front.guard", "top", "core"),
        "lanes": ("core.costs.sums.criterion", "costs.differences.row"),
        "other costs": ("core.costs", "core.costs.slots", "costs.weights"),
        "winners": ("core.winners.tree.node", "winners"),
        "post": ("core.fill", "median.window.lines"),
    }
    found = [Block(name=each, lut4=1, ff=2, ebr=3, dsp=4) for of_room in names.values() for each in of_room]
    assert rooms_of(found) == {
        room: {"lut4": len(each), "ff": 2 * len(each), "ebr": 3 * len(each), "dsp": 4 * len(each)}
        for room, each in names.items()
    }


def test_the_study_is_of_a_clock_a_pixel_in_1080p():
    core = pixel_a_clock.config()
    assert (core.steps, core.max_width) == (1, 1920)


def test_a_folder_without_the_row_is_told_how_to_get_it(tmp_path):
    with pytest.raises(InputError, match=r"no row robust/sum/32; run: softdepth utilization --row"):
        pixel_a_clock.routed_row(tmp_path)


def test_the_documents_table_is_what_the_figures_give(project):
    study = Study.model_validate_json((project / FIGURES).read_text())
    assert study.config == pixel_a_clock.config().hash
    assert f"-->\n{page(study)}\n<!--" in (project / DOCUMENT).read_text()
