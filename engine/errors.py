"""The errors and warnings a user can cause, each with a stable code and a sentence that says what to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


class GalateaError(Exception):
    """What a user can do something about. Anything else that is raised is a bug.

    code : stable (`no_face`, `video_unreadable`, ...).
    detail : one sentence that says what to do.
    correctable : the corrections (`landmarks`, `face_index`, ...) that could mend it.
    found : what helps with that, as JSON, such as the boxes of the faces to choose from.
    """

    def __init__(
        self, code: str, detail: str, correctable: tuple[str, ...] = (), found: Mapping[str, Any] | None = None
    ):
        super().__init__(f"{code}: {detail}")
        self.code = code
        self.detail = detail
        self.correctable = correctable
        self.found = dict(found or {})

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self.code, self.detail, self.correctable, self.found)


class InputError(GalateaError):
    """What the user gave cannot be used."""


class Canceled(Exception):
    """The run was told to stop; nothing is wrong with the input."""


@dataclass(frozen=True)
class Notice:
    """A warning that goes into the report: the result stands, but the user should know."""

    code: str
    message: str
