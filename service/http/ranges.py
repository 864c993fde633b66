"""Byte ranges and conditions of HTTP (RFC 9110, sections 13 and 14), as plain functions."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime

MAX_RANGES = 16
"""More ranges in one request than any player asks for are ignored, as the RFC allows."""


class Unsatisfiable(Exception):
    """None of the ranges lies inside the file."""


def parse_ranges(header: str | None, size: int) -> list[tuple[int, int]] | None:
    """The ranges that a `Range` header asks for, as (start, end) with `end` not included.

    None where the whole file is to be sent: no header, another unit, a malformed or an excessive one.
    Raises `Unsatisfiable`.
    """
    if header is None or not header.strip().lower().startswith("bytes="):
        return None
    parts = [part.strip() for part in header.strip()[6:].split(",", MAX_RANGES + 1)]
    if len(parts) > MAX_RANGES:
        return None
    ranges = []
    for part in filter(None, parts):
        parsed = _one(part, size)
        if parsed is None:
            return None
        ranges.append(parsed)
    if not ranges:
        return None
    inside = [(start, end) for start, end in ranges if start < end]
    if not inside:
        raise Unsatisfiable
    return _merge(inside)


def _one(part: str, size: int) -> tuple[int, int] | None:
    first, dash, last = (piece.strip() for piece in part.partition("-"))
    digits = all(piece == "" or (piece.isascii() and piece.isdigit() and len(piece) < 20) for piece in (first, last))
    if not dash or not digits or (first == "" and last == ""):
        return None
    if first == "":
        return max(size - int(last), 0), size
    if last == "":
        return int(first), size
    return (int(first), min(int(last) + 1, size)) if int(last) >= int(first) else None


def _merge(ranges: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """Overlapping ranges in one: otherwise a few bytes of request could ask for the file many times over."""
    if all(a[1] <= b[0] for i, a in enumerate(ranges) for b in ranges[i + 1 :]):
        return list(ranges)
    merged: list[tuple[int, int]] = []
    for start, end in sorted(ranges):
        if merged and start <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    return merged


def not_modified(if_none_match: str | None, if_modified_since: str | None, etag: str, modified: datetime) -> bool:
    """Whether the client's copy is still good (304)."""
    if if_none_match is not None:
        tags = [tag.strip().removeprefix("W/") for tag in if_none_match.split(",")]
        return "*" in tags or etag in tags
    moment = _date(if_modified_since)
    return moment is not None and modified.replace(microsecond=0) <= moment


def range_applies(if_range: str | None, etag: str, modified: datetime) -> bool:
    """Whether `If-Range` still names this very file, so that a part of it is what the client wants."""
    if if_range is None:
        return True
    if if_range.strip().startswith(('"', "W/")):
        return if_range.strip() == etag
    return _date(if_range) == modified.replace(microsecond=0)


def _date(text: str | None) -> datetime | None:
    try:
        moment = parsedate_to_datetime(text) if text else None
    except (ValueError, OverflowError):
        return None
    return moment.replace(tzinfo=UTC) if moment is not None and moment.tzinfo is None else moment  # “-0000”
