"""What a finding says: one line with the figure, and the remedy."""

from collections.abc import Callable

from softdepth.inspect.findings import MOST, Code, Finding

Figures = dict[str, float]


def problem(finding: Finding) -> str:
    """What is wrong, with its figure."""
    return _TEXTS[finding.code][0](finding.figures)


def remedy(finding: Finding) -> str:
    """What to do about it."""
    return _TEXTS[finding.code][1](finding.figures)


def line(finding: Finding) -> str:
    """Both, as one line."""
    return f"{problem(finding)}; {remedy(finding)}"


def _option(f: Figures) -> str:
    count = int(f["disparities"])
    if count <= MOST:
        return f"--disparities {count}"
    return f"images of at most {MOST / count:.2f} times the size, as {count} candidates are more than {MOST}"


def _wider(f: Figures) -> str:
    """The range to use after the remedy, where the one that was given would be too small."""
    return f", and use {_option(f)}" if f["disparities"] > f["given"] else ""


def _span(f: Figures) -> str:
    return f"{f['low']:.0f} .. {f['high']:.0f} px"


def _rows(f: Figures) -> str:
    way = "down" if f["offset"] > 0 else "up"
    return f"the right view's rows are offset by {abs(f['offset']):.1f} ({way})"


def _shift(f: Figures) -> str:
    """Which rows to cut: the right view's content lies lower by the offset, or higher."""
    count = max(1, round(abs(f["offset"])))
    first, second = ("right", "left") if f["offset"] > 0 else ("left", "right")
    return (
        f"rectify with a new calibration, or cut {count} rows off the {first} image's top and off the"
        f" {second} image's bottom"
    )


def _negative(f: Figures) -> str:
    return f"use --set min_disparity={f['wanted']:.0f}{_wider(f)}"


_TEXTS: dict[Code, tuple[Callable[[Figures], str], Callable[[Figures], str]]] = {
    "same": (
        lambda f: "left and right are the same picture: every disparity is 0",
        lambda f: "give the two views of a pair",
    ),
    "unmatched": (
        lambda f: (
            f"the views have hardly anything in common: {f['points']:.0f} of {f['keypoints']:.0f} points"
            " are found in both"
        ),
        lambda f: "check that they belong together, are taken at once and are rectified",
    ),
    "bare": (
        lambda f: f"there is nothing to match: {100 * f['share']:.0f} % of the image has no texture",
        lambda f: "light the scene, project a pattern onto it, or expose longer",
    ),
    "exchanged": (
        lambda f: (
            f"left and right are exchanged: {100 * f['share']:.0f} % of the disparities are negative"
            f" ({_span(f)})"
        ),
        lambda f: f"give the right image first{_wider(f)}",
    ),
    "unrectified": (
        lambda f: (
            f"the pair is not rectified: the rows' offset goes from {f['first']:+.1f} to {f['last']:+.1f}"
            f" over the image (the right view is turned by {f['degrees']:+.2f} degrees)"
        ),
        lambda f: "rectify it with the cameras' calibration",
    ),
    "rows": (_rows, _shift),
    "brightness": (
        lambda f: (
            f"the right view is {f['ratio']:.2f} times as bright as the left (contrast"
            f" {f['contrast']:.2f}, gamma {f['gamma']:.2f})"
        ),
        lambda f: "give both cameras one exposure, gain and gamma, or equalise the images",
    ),
    "contrast": (
        lambda f: f"the right view has {f['ratio']:.2f} times the left's contrast",
        lambda f: "give both cameras one gamma and focus, or equalise the images",
    ),
    "uneven": (
        lambda f: (
            f"the light differs from place to place: the ratio of brightness varies by"
            f" +-{100 * f['spread']:.0f} %"
        ),
        lambda f: "take both views at once, under one light",
    ),
    "negative": (
        lambda f: (
            f"{100 * f['share']:.0f} % of the disparities lie below the first candidate, {f['first']:.0f}"
            f" ({_span(f)})"
        ),
        _negative,
    ),
    "short": (
        lambda f: (
            f"the range is too small: {100 * f['share']:.0f} % of the disparities lie beyond"
            f" {f['last']:.0f} ({_span(f)})"
        ),
        lambda f: f"use {_option(f)}",
    ),
    "needless": (
        lambda f: (
            f"the range is larger than needed: disparities are {_span(f)}"
            f" of {f['first']:.0f} .. {f['last']:.0f}"
        ),
        lambda f: f"{_option(f)} would do",
    ),
}
