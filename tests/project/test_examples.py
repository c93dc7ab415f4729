"""The examples do what they say; that of LiteX is tested with the exported package."""

import subprocess
import sys
from pathlib import Path

import numpy as np

from softdepth.golden import fixed_model
from softdepth.golden.data import synthetic
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


def test_the_amaranth_design_shows_what_is_near(project: Path) -> None:
    """Line for line what the fixed model says of the same frame."""
    script = project / "examples" / "amaranth_core.py"
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True)
    scene = synthetic.generate("steps", width=48, height=16, disparities=8)
    config = Config.preset("sad").override(["disparities=8", "lanes=4", "max_width=64", "max_height=32"])
    result = fixed_model.disparity(scene.left, scene.right, config)
    near = (result.code < Validity.BORDER) & (result.disparity >= 4)
    assert done.stdout.splitlines() == ["".join(np.where(row, "#", ".")) for row in near]
    assert 0.2 < near.mean() < 0.8
