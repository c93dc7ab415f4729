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


def mutated(block: type, old: str, new: str) -> Any:
    """`block` of its module's text with ``new`` in place of ``old``, which is there once."""
    text = inspect.getsource(sys.modules[block.__module__])
    assert text.count(old) == 1, f"'{old}' is no longer in {block.__module__}, or more than once"
    module = ModuleType(f"mutated_{block.__name__}")
    exec(compile(text.replace(old, new), module.__name__, "exec"), module.__dict__)
    return getattr(module, block.__name__)
