"""Other people's yosys flows read an exported core, and put its memories into block RAM."""

import math

import pytest

from softdepth.cli.info import memory_bits
from softdepth.export.core_file import export_core
from softdepth.hdl.verilog import TOP
from softdepth.spec.config import Config
from softdepth.studies.reading import built_presets, read

SECONDS_TO_READ = 60.0
"""Of which yosys takes less than one. The rest is for its start, on a machine that does other things."""
MEGABYTES = 1500
WITH_TABLES = ("robust", "robust-gray")
"""Presets with a memory that is written once: the reciprocals of the support."""
BANDED = [name for name in built_presets() if not Config.preset(name).whole_frame]
"""Presets whose line buffers and row memories are all memory; the others take minutes to synthesise."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("preset", "changes"), [*((preset, []) for preset in built_presets()), ("paper", ["lanes=32"])]
)
def test_cores_of_full_size_are_read(preset: str, changes: list[str]) -> None:
    """1280 columns wide, `paper` with 32 lanes too: in seconds, and no word is set by itself."""
    text = export_core(Config.preset(preset).override(["max_width=1280", *changes])).verilog
    found = read(text, "proc")
    assert found.seconds < SECONDS_TO_READ
    assert found.megabytes < MEGABYTES
    tables = [kind for kind in found.cells if kind.startswith("$meminit")]
    assert bool(tables) == (preset in WITH_TABLES)


@pytest.mark.slow
@pytest.mark.parametrize("preset", BANDED)
def test_default_cores_are_synthesised(preset: str) -> None:
    """For ECP5; modules are left as they are, which takes half of the time."""
    config = Config.preset(preset)
    found = read(export_core(config).verilog, f"synth_ecp5 -noflatten -top {TOP}")
    assert found.megabytes < MEGABYTES
    assert found.cells["DP16KD"] >= sum(memory_bits(config)) / FAMILIES["synth_ecp5"][1]


FAMILIES = {
    "synth_ecp5": ("DP16KD", 18432),
    "synth_xilinx": ("RAMB18E1", 18432),
    "synth_gowin": ("DPX9B", 18432),
    "synth_ice40": ("SB_RAM40_4K", 4096),
    "synth_nexus": ("PDPSC16K", 18432),
}
"""Commands of yosys, with the block RAM of each for one write and one read port, and its bits."""


@pytest.mark.slow
@pytest.mark.parametrize("command", FAMILIES)
def test_memories_are_block_ram_in_every_family(command: str) -> None:
    """Line buffer and row memories alike; what is left for logic is the result queue, far smaller."""
    config = Config.preset("sad").override(["disparities=4", "lanes=2", "max_width=640"])
    found = read(export_core(config).verilog, f"{command} -top {TOP}")
    block, bits = FAMILIES[command]
    in_memory = sum(memory_bits(config))
    # Depths are no powers of two, and slices no multiples of a block: up to twice the bits.
    assert in_memory / bits <= found.cells[block] <= 2 * math.ceil(in_memory / bits)
    flip_flops = sum(count for kind, count in found.cells.items() if "FF" in kind or kind.startswith("FD"))
    assert flip_flops < in_memory / 8
