"""Documents with measured parts: what a program writes is between two markers."""

from softdepth.spec.errors import InputError


def markers(name: str) -> tuple[str, str]:
    """The pair of comments around the part called `name`."""
    return f"<!-- {name}:begin -->", f"<!-- {name}:end -->"


def renew(text: str, document: str, name: str, content: str) -> str:
    """`text`, of `document`, with `content` between the markers of `name`.

    Raises `InputError` if the markers are missing.
    """
    first, last = markers(name)
    before, begin, rest = text.partition(first)
    _, end, after = rest.partition(last)
    if not begin or not end:
        raise InputError(f"{document} has lost its {name} markers", f"put {first} and {last} around them")
    return f"{before}{begin}\n{content}\n{end}{after}"
