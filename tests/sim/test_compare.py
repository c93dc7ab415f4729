"""Differences are listed completely, with their place."""

import numpy as np
import pytest

from softdepth.golden.maps import DisparityMap
from softdepth.sim.compare import mismatches
from softdepth.spec.errors import InputError


def blank() -> DisparityMap:
    return DisparityMap(np.full((4, 5), 7, np.uint16), np.zeros((4, 5), np.uint8))


def test_equal_maps_have_none() -> None:
    assert mismatches([blank(), blank()], [blank(), blank()]) == []


def test_lists_disparities_and_codes() -> None:
    got = [blank(), blank()]
    got[0].disparity[3, 1] = 8
    got[1].code[0, 4] = 2
    got[1].disparity[2, 0] = 0
    found = mismatches([blank(), blank()], got)
    assert [(m.frame, m.y, m.x) for m in found] == [(0, 3, 1), (1, 0, 4), (1, 2, 0)]
    assert str(found[0]) == "frame 0 y=3 x=1: expected 7 (FULL), got 8 (FULL)"
    assert str(found[1]) == "frame 1 y=0 x=4: expected 7 (FULL), got 7 (BORDER)"


def test_refuses_another_number_of_frames() -> None:
    with pytest.raises(InputError, match="expected 2 frames, got 1"):
        mismatches([blank(), blank()], [blank()])
