"""What the names in a job's `inputs` mean: uploaded files, the user's own drivers, built-in performances."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy.orm import Session

from engine.kind import Input, Kind
from engine.media.sniff import IMAGE_TYPES, VIDEO_TYPES
from service.drivers import repository as drivers
from service.files import repository as files
from service.ids import is_id
from service.kinds import library
from service.problems import FieldError, Problem

MEDIA_TYPES = {"image": IMAGE_TYPES, "video": VIDEO_TYPES}


@dataclass
class Resolved:
    """The inputs of a job: what each name stands for, and the files that the job thereby uses."""

    sources: dict[str, Any] = field(default_factory=dict)
    file_ids: set[str] = field(default_factory=set)


class Refused(Exception):
    """One value cannot be taken."""

    def __init__(self, code: str, detail: str):
        super().__init__(detail)
        self.code = code
        self.detail = detail


def resolve(session: Session, kind: Kind, given: Mapping[str, str | list[str]]) -> Resolved:
    """Look up everything that is given. Raises a 422 problem that lists every wrong input."""
    resolved = Resolved()
    errors = []
    offered = {item.name: item for item in kind.inputs}
    for name in given:
        if name not in offered:
            names = ", ".join(offered)
            errors.append(_error(name, "unknown_input", f"{kind.name} has no input “{name}”; it has {names}."))
    for item in kind.inputs:
        try:
            if (source := _source(session, item, given.get(item.name), resolved.file_ids)) is not None:
                resolved.sources[item.name] = source
        except Refused as refused:
            errors.append(_error(item.name, refused.code, refused.detail))
    if errors:
        raise Problem(422, errors[0].code, errors[0].detail, errors)
    return resolved


def _source(session: Session, item: Input, value: str | list[str] | None, used: set[str]) -> Any:
    if value is None or value == []:
        if item.required:
            raise Refused("missing_input", f"The input “{item.name}” is missing: {item.description}")
        return None
    if isinstance(value, list) and not item.many:
        if len(value) != 1:
            raise Refused("too_many_files", f"The input “{item.name}” takes one file.")
        value = value[0]
    if isinstance(value, list):
        return [_one(session, item, one, used) for one in value]
    return [_one(session, item, value, used)] if item.many else _one(session, item, value, used)


def _one(session: Session, item: Input, value: str, used: set[str]) -> dict[str, str]:
    if "://" in value:
        raise Refused("url_unsupported", f"“{item.name}” is an address: upload the file and give its id instead.")
    file_id = value
    if not is_id(value):
        if item.library is None:
            raise Refused("unknown_file", f"“{item.name}” is not the id of a file: upload it first.")
        own = drivers.get(session, value)
        if own is None:
            if value not in library.names(item.library):
                raise Refused("unknown_driver", f"There is no driver “{value[:80]}”: GET /v1/drivers lists them.")
            return {"library": item.library, "name": value}
        file_id = own.file_id
    file = files.get(session, file_id)
    if file is None:
        raise Refused("unknown_file", f"There is no file {value} for “{item.name}”: it was erased, or never was.")
    if item.media in MEDIA_TYPES and file.content_type not in MEDIA_TYPES[item.media]:
        raise Refused("input_wrong_media", f"“{item.name}” must be of type {item.media}; this is {file.content_type}.")
    used.add(file.id)
    return {"file": file.id}


def _error(name: str, code: str, detail: str) -> FieldError:
    return FieldError(pointer=f"/inputs/{name}", code=code, detail=detail)
