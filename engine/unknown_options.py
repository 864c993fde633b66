"""What is said of an option that a job kind does not have."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from pydantic import BaseModel
from pydantic_core import ErrorDetails

MAX_COMPARED_CHARACTERS = 80
"""Characters of a name that are compared, which takes time by the square of them."""


def with_suggestions(errors: Sequence[ErrorDetails], options: type[BaseModel]) -> list[ErrorDetails]:
    """pydantic's errors, those of unknown options with what is nearest by name, or all there are."""
    return [_explained(error, sorted(options.model_fields)) for error in errors]


def _explained(error: ErrorDetails, names: Sequence[str]) -> ErrorDetails:
    if error["type"] != "extra_forbidden" or len(error["loc"]) != 1:
        return error
    near = get_close_matches(str(error["loc"][0])[:MAX_COMPARED_CHARACTERS], names, n=1)
    there = f"did you mean {near[0]}?" if near else f"there are {', '.join(names)}."
    return {**error, "msg": f"There is no such option: {there}"}
