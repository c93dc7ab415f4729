"""``softdepth ros``: a ROS 2 bag of images into a bag of depth."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from softdepth import screen
from softdepth.cli import metres, options
from softdepth.cli.bundle import bundled
from softdepth.run import measure
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.ros.bag import BagPair
    from softdepth.ros.convert import Disparities, RigTopics

RIG = "/left/image_rect,/right/image_rect"


@bundled
def ros(
    bag: Annotated[Path, typer.Argument(metavar="BAG", help="Folder of a ROS 2 bag, db3 or mcap.")],
    choice: options.Choice,
    kept: metres.Kept,
    rigs: Annotated[
        list[str] | None,
        typer.Option(
            "--rig",
            metavar="LEFT,RIGHT[,NAMESPACE]",
            help=f"Image topics of a rig, and where its results go; repeatable [default: {RIG},/stereo]."
            " Each camera_info is the topic of that name beside the images.",
        ),
    ] = None,
    tolerance: Annotated[
        float, typer.Option("--tolerance", metavar="S", help="Seconds that a pair's stamps may differ by.")
    ] = 0.0,
    storage: Annotated[
        Literal["mcap", "db3"], typer.Option("--storage", help="How the new bag is stored.")
    ] = "mcap",
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="The new bag's folder.")
    ] = Path("depth_bag"),
) -> None:
    """Compute the depth of a bag's stereo images: disparity, depth images and points, into another bag."""
    from softdepth.ros import bag as bags
    from softdepth.ros.convert import Further, convert
    from softdepth.ros.messages import Search

    if not 0 <= tolerance < float("inf"):
        raise InputError(f"--tolerance {tolerance:g} is not a time", "give seconds, for example 0.005")
    read = [_rig(text) for text in rigs or [f"{RIG},/stereo"]]
    config = choice.configuration()
    kept.check(config)
    limits = [key for key in measure.LIMITS if not choice.sets(key)]
    with bags.opened(bag) as reader:
        total = sum(bags.count(reader, rig.topics) for rig in read)
    least = float(config.min_disparity)
    search = Search(least, least + config.disparities - 1, 1 / (1 << config.post.fraction_bits))
    with screen.progress("pairs", total, "pairs") as advance:
        done = convert(
            bag,
            output,
            read,
            lambda pair: _compute(pair, config, limits),
            search,
            storage=storage,
            tolerance=tolerance,
            choice=kept.choice(),
            further=Further(config.post.confidence, kept.disparity_error),
            progress=advance,
        )
    for namespace, found in done.pairs.items():
        print(f"{namespace}: {found} pairs")
    print(f"bag: {output}")


def _rig(text: str) -> "RigTopics":
    from softdepth.ros.bag import Topics
    from softdepth.ros.convert import RigTopics

    names = text.split(",")
    if len(names) not in (2, 3) or not all(name.startswith("/") for name in names):
        raise InputError(
            f"--rig {text} is not LEFT,RIGHT or LEFT,RIGHT,NAMESPACE", f"write --rig {RIG},/stereo"
        )
    left, right = names[:2]
    if left == right:
        raise InputError(f"--rig {text} has one topic for both views", "name the left and the right one")
    infos = (f"{name.rpartition('/')[0]}/camera_info" for name in (left, right))
    namespace = names[2] if len(names) == 3 else left.rpartition("/")[0].rpartition("/")[0] or "/stereo"
    return RigTopics(Topics(left, right, *infos), namespace)


def _compute(pair: "BagPair", config: Config, limits: list[str]) -> "Disparities":
    """A pair through the fixed-point model, in a core that is as large as it where `limits` are not set."""
    from softdepth.golden import fixed_model
    from softdepth.golden.data.pair import StereoPair
    from softdepth.ros.convert import Disparities

    bits = 16 if pair.left.dtype.itemsize == 2 else 8
    stereo = StereoPair(pair.left, pair.right, "bag", bits=bits).as_format(config.pixel)
    fitting = measure.as_large_as(stereo, config, limits)
    measure.check_fits(stereo, fitting, again=options.command)
    found = fixed_model.disparity(stereo.left, stereo.right, fitting)
    return Disparities(found.pixels, found.code, found.confidence)
