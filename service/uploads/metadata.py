"""`Upload-Metadata`: pairs of a key and a value in base64, separated by commas."""

from __future__ import annotations

import base64
import binascii

from service.problems import Problem

MAX_METADATA_CHARACTERS = 8000
"""Characters of the header; together with the others it must fit into what a server takes of headers at all."""


def parse(header: str) -> dict[str, str]:
    """The pairs of the header. Raises a 422 problem if it is not as the protocol says."""
    if len(header) > MAX_METADATA_CHARACTERS:
        raise _invalid(f"it has more than {MAX_METADATA_CHARACTERS} characters")
    pairs: dict[str, str] = {}
    for pair in header.split(",") if header.strip() else ():
        key, _, value = pair.strip(" ").partition(" ")
        if not key or not key.isascii() or not key.isprintable():
            raise _invalid("a key is missing or not ASCII")
        if key in pairs:
            raise _invalid(f"the key “{key[:80]}” is there twice")
        try:
            pairs[key] = base64.b64decode(value, validate=True).decode()
        except (binascii.Error, UnicodeDecodeError, ValueError):
            raise _invalid(f"the value of “{key[:80]}” is not UTF-8 text in base64") from None
    return pairs


def _invalid(why: str) -> Problem:
    return Problem(422, "invalid_upload_metadata", f"Upload-Metadata cannot be read: {why}.")
