"""Gateware with faults put into its text: what a bench must catch."""

import inspect
import sys
from importlib import resources
from types import ModuleType
from typing import Any

FRAME_GUARD, HEIGHT_LEARNER, COLUMNS = "frame_guard", "height_learner", "columns"
PARTS = {HEIGHT_LEARNER: "HeightLearner", COLUMNS: "Columns"}


def mutated_guard(file: str, old: str, new: str) -> type:
    """FrameGuard with ``new`` in place of ``old`` in one of its files."""
    modules = {}
    for name in (*PARTS, FRAME_GUARD):
        text = resources.files("softdepth.hdl.front").joinpath(f"{name}.py").read_text()
        if name == file:
            assert old in text, f"'{old}' is no longer in {name}.py"
            text = text.replace(old, new)
        modules[name] = module = ModuleType(f"mutated_{name}")
        exec(compile(text, name, "exec"), module.__dict__)
    for name, part in PARTS.items():
        modules[FRAME_GUARD].__dict__[part] = modules[name].__dict__[part]
    return modules[FRAME_GUARD].__dict__["FrameGuard"]


def mutated(block: type, *texts: str) -> Any:
    """`block` of its module's text with the second text in place of the first, which is there once.

    And with the fourth in that of the third, and so on.
    """
    text = inspect.getsource(sys.modules[block.__module__])
    for old, new in zip(texts[::2], texts[1::2], strict=True):
        assert text.count(old) == 1, f"'{old}' is no longer in {block.__module__}, or more than once"
        text = text.replace(old, new)
    module = ModuleType(f"mutated_{block.__name__}")
    exec(compile(text, module.__name__, "exec"), module.__dict__)
    return getattr(module, block.__name__)
