"""An exported core in Icarus Verilog, under a bench of its own."""

import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from tests.support.verilog import ports

STANDARDS = ("-g2005", "-g2012")
BENCH = Path(__file__).with_name("bench.v")

needs_icarus = pytest.mark.skipif(
    shutil.which("iverilog") is None, reason="Icarus is not installed: sudo apt install iverilog"
)


@dataclass
class Seen:
    """What the bench saw: clocks of pixels taken and of results, results, the counters, complaints."""

    taken: list[int] = field(default_factory=list)
    given: list[int] = field(default_factory=list)
    payloads: list[int] = field(default_factory=list)
    status: int = -1
    complaints: list[str] = field(default_factory=list)


def run_icarus(
    verilog: str,
    pixels: Sequence[int],
    folder: Path,
    *,
    standard: str = "-g2012",
    reset_clocks: int = 1,
    stalls: bool = False,
    gap: int = 0,
    patience: int = 600,
) -> Seen:
    """Send packed pixel pairs; `gap` is the number of clocks between two at least, 0 for a full rate."""
    width = {name: bits for name, (_, bits) in ports(verilog, "softdepth_core").items()}
    (folder / "core.v").write_text(verilog)
    (folder / "pixels.hex").write_text("\n".join(f"{pixel:x}" for pixel in pixels))
    defines = {
        "I_BITS": width["i_payload"],
        "O_BITS": width["o_payload"],
        "STATUS_BITS": width["status"],
        "PIXELS": len(pixels),
        "RESET_CLOCKS": reset_clocks,
        "STALLS": int(stalls),
        "GAP": gap,
        "PATIENCE": patience,
    }
    flags = [f"-D{name}={value}" for name, value in defines.items()]
    _run(["iverilog", standard, *flags, "-o", "bench", str(BENCH), "core.v"], folder)
    seen = Seen()
    for line in _run(["vvp", "-n", "bench"], folder).splitlines():
        kind, _, rest = line.partition(" ")
        match kind:
            case "T":
                seen.taken.append(int(rest))
            case "R":
                clock, _, payload = rest.partition(" ")
                seen.given.append(int(clock))
                seen.payloads.append(int(payload, 16) if "x" not in payload.lower() else -1)
            case "S":
                seen.status = int(rest, 16)
            case "X" | "W":
                seen.complaints.append(line)
    return seen


def _run(command: list[str], folder: Path) -> str:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout
