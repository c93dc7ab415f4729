"""`Sad.stored_rows` stated once, beside the criteria."""

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from softdepth.spec.criteria import AnyCriterion, Sad, criterion_of

KEY = "stored_rows"


def of_the_highest(given: Mapping[str, Any], default: tuple[AnyCriterion, ...]) -> dict[str, Any]:
    """Plain data in which the highest SAD (the first of these) stores the rows that `KEY` says, others none.

    Raises `ValueError` for anything but a number of rows, or for more than that window has above its newest.
    """
    rest = {key: value for key, value in given.items() if key != KEY}
    rows = given[KEY]
    if type(rows) is not int or rows < 0:
        raise ValueError(f"{KEY} = {rows!r} is not valid: use a number of rows, from 0 up")
    try:
        criteria = [criterion_of(each) for each in rest.get("criteria", default)]
    except (ValidationError, PydanticCustomError, TypeError):
        return rest  # reading them says so
    highest = max((c for c in criteria if isinstance(c, Sad)), key=lambda c: c.window, default=None)
    most = highest.window - 1 if highest else 0
    if rows > most:
        raise ValueError(
            f"{KEY} is {rows}, but a window of {most + 1} rows has {most} above its newest:"
            " use at most that many"
        )
    for i, criterion in enumerate(criteria):
        if isinstance(criterion, Sad):
            criteria[i] = criterion.model_copy(update={KEY: 0})
    if highest is not None:
        place = next(i for i, c in enumerate(criteria) if isinstance(c, Sad) and c.window == highest.window)
        criteria[place] = criteria[place].model_copy(update={KEY: rows})
    return {**rest, "criteria": criteria}
