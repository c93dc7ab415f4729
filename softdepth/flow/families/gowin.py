"""Gowin's parts, through nextpnr's himbaechel and Apycula."""

from softdepth.flow.families.family import Family, Part
from softdepth.spec.boards import gowin_die


class Gowin(Family):
    """Gowin parts of the GW2A kind by yosys, nextpnr-himbaechel and Apycula."""

    placer = "nextpnr-himbaechel"
    packer = "gowin_pack"
    suffix = ".fs"
    # yosys would add pads to every module it maps separately: only the top gets them, at the end.
    pads = (
        "iopadmap -bits -inpad IBUF O:I -outpad OBUF I:O -toutpad TBUF ~OEN:I:O -tinoutpad IOBUF ~OEN:O:I:IO;"
    )

    def synthesis(self, top: str) -> str:
        return f"synth_gowin -top {top} -noiopads"

    def synthesis_options(self, part: Part) -> tuple[str, ...]:
        return ("-family", gowin_die(part.device).partition("-")[0].lower())

    def place(self, part: Part, netlist: str, placed: str, constraints: str | None) -> list[str]:
        pins = ["--vopt", f"cst={constraints}"] if constraints else []
        device = ["--device", part.device, "--vopt", f"family={gowin_die(part.device)}"]
        return [*device, *pins, "--json", netlist, "--write", placed]

    def pack(self, part: Part, placed: str, bitstream: str) -> list[str]:
        return ["-d", gowin_die(part.device), "-o", bitstream, placed]
