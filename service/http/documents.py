"""JSON that strangers send: what of it is read at all.

All that works with a document that was read may take three things for granted. Texts can be stored and shown again:
they hold no half characters, which UTF-8 does not have, and no NUL, which PostgreSQL does not keep. Numbers are numbers.
A walk over the whole is short and not deep.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from math import isfinite
from typing import Any

from service.problems import Problem

MAX_NAMES = 5000
"""The most names in all objects of a document: an option with 1,000 strokes has 3,000."""
MAX_JSON_DEPTH = 50
"""The most arrays and objects within each other."""
MAX_NUMBER = 1.7e308
"""The largest number: beyond it, most programs read infinity."""


def parse_json(text: str | bytes, what: str) -> Any:
    """What a JSON text holds. Raises a 422 problem: `invalid_json`, `json_too_deep`, `too_many_names`,
    `number_too_large`, `invalid_request`."""
    try:
        value = json.loads(text, parse_constant=_no_number)
    except RecursionError:
        raise _too_deep(what) from None
    except ValueError:
        raise Problem(422, "invalid_json", f"{what} is not valid JSON.") from None
    _require_bounded(value, what)
    return value


def require_text(texts: Iterable[str], what: str) -> None:
    """Raise a 422 problem if one of the texts holds what cannot be kept."""
    for text in texts:
        if "\0" in text:
            raise Problem(422, "invalid_request", f"{what} holds a character that cannot be kept (NUL).")
        if not text.isascii():
            try:
                text.encode()
            except UnicodeEncodeError:
                detail = f"{what} holds half a character (a lone surrogate)."
                raise Problem(422, "invalid_json", detail) from None


def _require_bounded(value: Any, what: str) -> None:
    """Walk over a document level by level, which takes no more of the stack however deep it is."""
    level, names = [value], 0
    for _ in range(MAX_JSON_DEPTH + 1):
        below: list[Any] = []
        for one in level:
            if isinstance(one, str):
                require_text((one,), what)
            elif isinstance(one, list):
                below += one
            elif isinstance(one, dict):
                names += len(one)
                if names > MAX_NAMES:
                    detail = f"{what} has more than {MAX_NAMES} names: send no more than is asked for."
                    raise Problem(422, "too_many_names", detail)
                require_text(one, what)
                below += one.values()
            elif isinstance(one, int | float) and not _is_number(one):
                raise Problem(422, "number_too_large", f"{what} holds a number beyond {MAX_NUMBER:g}.")
        level = below
        if not level:
            return
    raise _too_deep(what)


def _is_number(value: float) -> bool:
    return isfinite(value) if isinstance(value, float) else abs(value) <= MAX_NUMBER


def _too_deep(what: str) -> Problem:
    return Problem(422, "json_too_deep", f"{what} has more than {MAX_JSON_DEPTH} arrays and objects within each other.")


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is no JSON")
