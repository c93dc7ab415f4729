"""``softdepth sequence``: videos, folders and rigs of stereo pairs to depth."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from softdepth import screen
from softdepth.cli import calibrations, metres, options, pairs, sequences
from softdepth.cli.bundle import bundled
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.sequence.rigs import RigFolder


@bundled
def sequence(
    left: Annotated[
        Path,
        typer.Argument(
            metavar="LEFT",
            help="Left frames: a folder, a pattern in quotes, or a video; alone, a folder of rigs.",
        ),
    ],
    choice: options.Choice,
    cameras: metres.Cameras,
    raw: calibrations.Raw,
    kept: metres.Kept,
    right: Annotated[
        Path | None, typer.Argument(metavar="RIGHT", help="Right frames, of the same kind.")
    ] = None,
    truth: Annotated[
        Path | None,
        typer.Option("--gt", metavar="DIR", help="Known disparities, a file a frame: a folder or a pattern."),
    ] = None,
    truth_scale: pairs.TruthScale = None,
    bits: pairs.Bits = None,
    side_by_side: pairs.SideBySide = False,
    top_bottom: pairs.TopBottom = False,
    rigs_raw: Annotated[
        bool, typer.Option("--raw", help="Rigs are raw: rectify each by the calibration in its folder.")
    ] = False,
    engine: Annotated[
        Literal["fixed", "rtl"],
        typer.Option("--engine", help="What computes the result: the model, or simulated gateware."),
    ] = "fixed",
    processes: sequences.Processes = None,
    fps: sequences.Rate = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of frames, tables and preview.")
    ] = Path("out/sequence"),
) -> None:
    """Compute the depth of a sequence of stereo pairs; what is there from an earlier run is kept."""
    from softdepth.processes import cores

    kept.choice()
    joined = pairs.joined(side_by_side, top_bottom)
    given = sequences.Given(left, right, joined, bits, truth, truth_scale)
    how = sequences.How(engine, processes or cores(), fps)
    if right is not None or given.joined is not None or not left.is_dir():
        if rigs_raw:
            raise InputError(f"--raw without a folder of rigs: '{left}'", "use --rectify FILE")
        planned = [sequences.Plan("", given, cameras, raw, output)]
    else:
        from softdepth.sequence import rigs

        found = rigs.find(left)
        planned = [
            _rig_plan(rig, given, cameras, raw, rigs_raw, output if len(found) == 1 else output / rig.name)
            for rig in found
        ]
        if len(found) > 1:
            planned = [_own_frame(plan, cameras) for plan in planned]
    ready = [sequences.prepare(plan, choice, kept, how) for plan in planned]
    for plan, each in zip(planned, ready, strict=True):
        if plan.name:
            screen.note(f"rig {plan.name}: {len(each.checked.names)} frames")
    mismatches = [sequences.run(each, how) for each in ready]
    sequences.fail_on_mismatch(sum(mismatches))


def _rig_plan(
    rig: "RigFolder",
    given: sequences.Given,
    cameras: metres.Cameras,
    raw: calibrations.Raw,
    rigs_raw: bool,
    output: Path,
) -> sequences.Plan:
    """A rig with the calibration in its folder."""
    if given.truth is not None:
        raise InputError(
            f"--gt {given.truth} with a folder of rigs", "put each rig's truths into a folder called truth"
        )
    here = replace(given, left=rig.left, right=rig.right, truth=rig.truth)
    if not rig.calibration:
        if rigs_raw:
            raise InputError(
                f"rig '{rig.name}' should be rectified, but has no calibration", "put its file beside left/"
            )
        return sequences.Plan(rig.name, here, cameras, raw, output)
    paths = list(rig.calibration)
    if cameras.calibration or raw.rectify:
        other = (cameras.calibration or raw.rectify or [])[0]
        raise InputError(
            f"'{other}' and '{paths[0]}' both calibrate rig '{rig.name}'", "leave one of them out"
        )
    if rigs_raw:
        return sequences.Plan(rig.name, here, cameras, replace(raw, rectify=paths), output)
    if calibrations.rig(paths, cameras.unit).rectification is None:
        raise InputError(
            f"'{paths[0]}' is the calibration of raw images", "add --raw, so that they are rectified with it"
        )
    return sequences.Plan(rig.name, here, replace(cameras, calibration=paths), raw, output)


def _own_frame(plan: sequences.Plan, cameras: metres.Cameras) -> sequences.Plan:
    """The plan of one of several rigs, in a frame of its own where depth in metres is wanted."""
    if cameras.frame_id is not None:
        raise InputError(
            f"--frame-id {cameras.frame_id} for several rigs", "leave it out: each has its folder's name"
        )
    if not plan.cameras.given and not plan.raw.rectify:
        return plan
    frame_id = "_".join(plan.name.split()) + "_left_camera_optical_frame"
    return replace(plan, cameras=replace(plan.cameras, frame_id=frame_id))
