"""What stands for a row of the table of area and speed, without nextpnr."""

from softdepth.flow.route import Clock, CriticalPath, Routed, Usage
from softdepth.studies.utilization import PART, Row, Selection, row_of

KEYS = (
    "device preset operator disparities lanes width lut4 ff ebr dsp fmax_mhz"
    " cycles_per_pixel mpixel_s mde_s mde_s_per_klut lut4_per_lane"
)

PATH = CriticalPath("core.a", "core.b", 8.0, 5)


def routed(fmax: float = 125.0, luts: int = 8000) -> Routed:
    counts = {"Total LUT4s": luts, "Total DFFs": 9000, "DP16KD": 12, "MULT18X18D": 34}
    usage = {word: Usage(count, 83640) for word, count in counts.items()}
    return Routed((Clock("clk", 150.0, fmax, PATH),), usage, 1)


def row(fmax: float = 125.0, luts: int = 8000, lanes: int = 16) -> Row:
    config = Selection(preset="paper", operator="mean", lanes=lanes).config()
    return row_of(config, "paper", PART, routed(fmax, luts))
