"""``softdepth board``: a stereo pair to depth on an FPGA board, measured."""

from pathlib import Path
from typing import Annotated

import typer

from softdepth import screen
from softdepth.cli import calibrations, metres, options, pairs, run, sequences
from softdepth.cli.bundle import bundled
from softdepth.spec.boards import BOARDS, find_board
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError

DEFAULT_BOARD = "ulx3s-85f"


@bundled
def board(
    port: Annotated[str, typer.Option("--port", metavar="PORT", help="Serial port, e.g. /dev/ttyUSB0.")],
    source: pairs.Source,
    choice: options.Choice,
    name: Annotated[
        str, typer.Option("--board", metavar="NAME", help=f"One of {', '.join(BOARDS)}: for the baud rate.")
    ] = DEFAULT_BOARD,
    baud: Annotated[
        int | None, typer.Option("--baud", metavar="N", help="Bits per second, where not the board's own.")
    ] = None,
    timeout: Annotated[
        float,
        typer.Option("--timeout", metavar="S", help="Seconds without an answer before packets are repeated."),
    ] = 0.5,
    processes: sequences.Processes = None,
    fps: sequences.Rate = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of pictures, maps and report.")
    ] = Path("out"),
) -> None:
    """Compute the depth of a stereo pair or a sequence on a board, and compare it with the models.

    The configuration is the board's; where one is given, the board has to hold it.
    """
    rate = find_board(name).baud if baud is None else baud
    if rate <= 0:
        raise InputError(f"--baud {rate} is not a rate", "give bits per second, for example 2000000")
    if not 0 < timeout < float("inf"):
        raise InputError(f"--timeout {timeout:g} is not a time", "give seconds, for example 0.5")
    wanted = choice.configuration() if choice.given else None
    from softdepth import files as results
    from softdepth.board.device import Device
    from softdepth.board.link import Link
    from softdepth.board.port import Port
    from softdepth.processes import cores
    from softdepth.run import measure, report

    source.keep_safe(output, (*report.FILES, results.LAST), choice.config)
    with Port(port, rate) as line:
        device = Device(Link(line, timeout))
        found = device.description
        if wanted is not None:
            device.check(wanted)
        chosen = found.config
        screen.note(f"{found.board}, {found.revision}: {chosen.name} ({chosen.hash})")
        if source.is_sequence:
            how = sequences.How("board", processes or cores(), fps, device)
            _sequence(source, chosen, how, output)
            return
        pair = source.read(chosen)
        measure.check_fits(pair, chosen, built=True)
        with results.result_folder(output, stale=report.FILES) as folder:
            measurement = measure.measure(pair, chosen, "board", device)
            summary = report.summarise(pair, chosen, measurement)
            report.write(folder, pair, chosen, measurement, summary)
    report.show(summary)
    print(f"results: {output}")
    run.fail_on_mismatch(pair, chosen, measurement)


def _sequence(source: pairs.Source, config: Config, how: sequences.How, output: Path) -> None:
    """A sequence through a core that is there already."""
    if source.dataset is not None or source.left is None:
        raise InputError(f"--dataset {source.dataset} with a sequence", "leave one of them out")
    given = sequences.Given(
        source.left, source.right, source.joined, source.bits, source.truth, source.truth_scale
    )
    plan = sequences.Plan("", given, metres.Cameras(), calibrations.Raw(), output)
    ready = sequences.prepare(plan, None, metres.Kept(), how, config)
    sequences.fail_on_mismatch(sequences.run(ready, how))
