"""What a result is called when it is saved: after its picture and what the picture does, as `grace-hopper-happy.mp4`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from service.ids import is_id

MAX_PART_CHARACTERS = 60
"""The longest part of a name."""

PICTURE_FIELDS = ("portrait", "photo")
"""Names in a job's metadata that tell of its picture."""
PERFORMANCE_FIELDS = ("performance", "motion")
"""Names in a job's metadata that tell of what it does."""


def download_name(
    artifact: str, metadata: Mapping[str, Any], inputs: Mapping[str, Any], options: Mapping[str, Any]
) -> str:
    """The name under which a job's artifact is saved: letters, digits and dashes, then its ending.

    The animation has the job's name alone, everything else its own name, too. Where the job says nothing of its
    picture, the artifact's own name stays.
    """
    picture = _words(_first(metadata, PICTURE_FIELDS))
    if not picture:
        return artifact
    named = inputs.get("driver") or inputs.get("motion") or options.get("motion")
    known = named if isinstance(named, str) and not is_id(named) and "://" not in named else ""
    parts = [picture, _words(_first(metadata, PERFORMANCE_FIELDS) or known)]
    stem, _, ending = artifact.rpartition(".")
    if stem != "animation":
        parts.append(_words(stem))
    return "-".join(filter(None, parts)) + f".{ending}"


def _first(metadata: Mapping[str, Any], names: tuple[str, ...]) -> str:
    return next((value for name in names if isinstance(value := metadata.get(name), str) and value), "")


def _words(text: str) -> str:
    """Letters and digits of any script, and dashes between them: nothing that a file system or a shell reads."""
    return re.sub(r"[\W_]+", "-", text.casefold()).strip("-")[:MAX_PART_CHARACTERS].strip("-")
