"""What the regression asks of every run."""

from collections.abc import Callable

import pytest

from softdepth.golden import fixed_model
from softdepth.sim.compare import mismatches
from softdepth.sim.frames import FramesResult, Pair, run_frames
from softdepth.sim.stage import explain
from softdepth.spec.config import Config

Exact = Callable[..., FramesResult]


@pytest.fixture(scope="session")
def exact() -> Exact:
    """Run pairs through the gateware and require that every pixel and code equals the fixed model's."""

    def check(config: Config, pairs: list[Pair], **options: object) -> FramesResult:
        result = run_frames(config, pairs, **options)  # type: ignore[arg-type]
        expected = [fixed_model.disparity(left, right, config) for left, right in pairs]
        found = mismatches(expected, result.maps)
        assert not found, "\n".join(
            [f"{len(found)} mismatches", *explain(config, pairs, expected, result.maps)]
        )
        return result

    return check
