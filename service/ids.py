"""Identifiers that sort by the time they were made (UUID version 7, RFC 9562, section 5.7)."""

from __future__ import annotations

import secrets
import threading
import time
from uuid import UUID

from pydantic.config import JsonDict
from starlette.convertors import StringConvertor, register_url_convertor

ID_PATTERN = "[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}"
LIKE_AN_ID: JsonDict = {"pattern": f"^{ID_PATTERN}$"}
"""What the OpenAPI document tells of a parameter that is an id; `is_id` checks it, so that the error has its code."""


class IdConvertor(StringConvertor):
    """`{name:id}` in the path of a route stands for ids alone, where an address beside it is a word."""

    regex = ID_PATTERN


register_url_convertor("id", IdConvertor())


_lock = threading.Lock()
_last = 0


def new_id() -> str:
    """A fresh UUIDv7 in its usual 36 characters: 60 bits of time, 62 random bits.

    The twelve bits after the milliseconds hold their fraction (RFC 9562, section 6.2, method 3), and no two ids of a
    process share a time: they sort in the order in which they were made."""
    global _last
    with _lock:
        _last = max(time.time_ns() * 4096 // 1_000_000, _last + 1)
        milliseconds, fraction = divmod(_last, 4096)
    value = milliseconds << 80 | 0x7 << 76 | fraction << 64 | 0b10 << 62 | secrets.randbits(62)
    return str(UUID(int=value))


def is_id(text: str) -> bool:
    """Whether a text is a UUID in its usual form (and so never the name of a driver)."""
    try:
        return str(UUID(text)) == text
    except ValueError:
        return False
