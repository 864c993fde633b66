"""Identifiers that sort by the time they were made (UUID version 7, RFC 9562, section 5.7)."""

from __future__ import annotations

import secrets
import time
from uuid import UUID

from pydantic.config import JsonDict
from starlette.convertors import StringConvertor, register_url_convertor

SHAPE = "[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}"
LIKE_AN_ID: JsonDict = {"pattern": f"^{SHAPE}$"}
"""What the OpenAPI document tells of a parameter that is an id; `is_id` checks it, so that the error has its code."""


class IdConvertor(StringConvertor):
    """`{name:id}` in the path of a route stands for ids alone, where an address beside it is a word."""

    regex = SHAPE


register_url_convertor("id", IdConvertor())


def new_id() -> str:
    """A fresh UUIDv7 in its usual 36 characters: 48 bits of milliseconds, 74 random bits."""
    milliseconds = time.time_ns() // 1_000_000
    value = milliseconds << 80 | 0x7 << 76 | secrets.randbits(12) << 64 | 0b10 << 62 | secrets.randbits(62)
    return str(UUID(int=value))


def is_id(text: str) -> bool:
    """Whether a text is a UUID in its usual form (and so never the name of a driver)."""
    try:
        return str(UUID(text)) == text
    except ValueError:
        return False
