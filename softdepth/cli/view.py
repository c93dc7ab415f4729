"""``softdepth view``: one page that shows a pair's depth."""

from pathlib import Path
from typing import Annotated

import typer

from softdepth import screen
from softdepth.cli import calibrations, metres, options, pairs
from softdepth.cli.bundle import bundled
from softdepth.spec.errors import InputError


@bundled
def view(
    source: pairs.Source,
    choice: options.Choice,
    cameras: metres.Cameras,
    raw: calibrations.Raw,
    kept: metres.Kept,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The page.")] = Path(
        "view.html"
    ),
) -> None:
    """Write one HTML page of a pair: left image, depth, confidence, and points to turn with the mouse."""
    kept.choice()
    from softdepth.files import write_atomically
    from softdepth.golden import fixed_model
    from softdepth.view.page import page

    raw.check(source.dataset)
    calibrated = (*(raw.rectify or ()), *(cameras.calibration or ()))
    source.keep_safe(output.parent, [output.name], choice.config, *calibrated)
    pair, config = source.read_for(choice)
    pair, geometry, _ = metres.prepare(pair, cameras, raw)
    if geometry is None:
        geometry = cameras.geometry((pair.width, pair.height))  # says what is missing
    kept.check(config)
    if kept.disparity_error is not None:
        raise InputError(f"--disparity-error {kept.disparity_error:g} for a page", "give it to softdepth run")
    screen.note("fixed-point model ...")
    found = fixed_model.disparity(pair.left, pair.right, config)
    scene = metres.scene_of(found, geometry, kept, pair)
    text = page(pair.name, scene, found.confidence, metres.facts(scene, pair, config))
    write_atomically(output, text.encode())
    print(f"page: {output}")
