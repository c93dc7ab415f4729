"""What the regression asks of every run."""

from collections.abc import Callable

import pytest

from softdepth.config import Config
from softdepth.golden import fixed_model
from softdepth.sim.compare import mismatches
from softdepth.sim.frames import FramesResult, Pair, run_frames

Exact = Callable[..., FramesResult]


@pytest.fixture(scope="session")
def exact() -> Exact:
    """Run pairs through the gateware and require that every pixel and code equals the fixed model's."""

    def check(config: Config, pairs: list[Pair], **options: object) -> FramesResult:
        result = run_frames(config, pairs, **options)  # type: ignore[arg-type]
        expected = [fixed_model.disparity(left, right, config) for left, right in pairs]
        found = mismatches(expected, result.maps)
        assert not found, f"{len(found)} mismatches: " + "; ".join(map(str, found[:5]))
        return result

    return check
