"""What the names in a job's `inputs` mean: uploaded files, addresses to fetch, the user's own drivers and motions,
built-in ones, what an earlier job made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pydantic import TypeAdapter, ValidationError
from sqlalchemy.orm import Session

from engine.kind import AUTO_CHOICE, Input, Kind
from engine.media.sniff import ARCHIVE_TYPES, IMAGE_TYPES, MOTION_TYPES, VIDEO_TYPES
from service.files import repository as files
from service.ids import is_id
from service.job_records import artifacts, jobs
from service.libraries import repository as kept
from service.libraries.library import LIBRARIES, Library
from service.outbound.address import AddressRefused, Network, require_callable
from service.problems import FieldError, Problem
from service.tables.files import File
from service.tables.jobs import Status
from service.uploads import repository as uploads

MAX_OWN_CANDIDATES = 6
"""How many of the user's own drivers `auto` looks at: looking at one costs a second or two."""

MODEL_TYPES = frozenset({"model/gltf-binary"})
MEDIA_TYPES = {
    "image": IMAGE_TYPES,
    "video": VIDEO_TYPES,
    "motion": MOTION_TYPES,
    "model": MODEL_TYPES,
    "photos": IMAGE_TYPES | ARCHIVE_TYPES,
    "performance": VIDEO_TYPES | IMAGE_TYPES,
    "persona": frozenset({"application/zip"}),  # a `.npz` is one
}

Value = str | list[str] | None
"""What can be given for an input; null is nothing."""
_VALUE_ADAPTER: TypeAdapter[Value] = TypeAdapter(Value)


@dataclass
class ResolvedInputs:
    """The inputs of a job: what each name stands for, and the files that the job thereby uses."""

    sources: dict[str, Any] = field(default_factory=dict)
    file_ids: set[str] = field(default_factory=set)


class ValueRefused(Exception):
    """One value cannot be taken."""

    def __init__(self, code: str, detail: str):
        super().__init__(detail)
        self.code = code
        self.detail = detail


@dataclass(frozen=True)
class _Lookup:
    """Where things are looked up, and for whom."""

    session: Session
    owner: str
    kind: str
    allowed: Sequence[Network]
    used: set[str]
    """Takes up the ids of the files that were found."""


def resolve(
    session: Session,
    owner: str,
    kind: Kind,
    options: Mapping[str, object],
    given: Mapping[str, Value],
    allowed: Sequence[Network] = (),
    revised: Mapping[str, Any] | None = None,
) -> ResolvedInputs:
    """Look up everything that is given to a job with these options; `allowed` are networks that addresses may lead to
    beside the public ones. Of a revision, `revised` are the parent's sources: what is given is given as corrections,
    and the other sources stay.

    Raises a 422 problem that lists every wrong input.
    """
    chosen = kind.options.model_validate(options)
    place = "/inputs" if revised is None else "/corrections"
    stays = {name: source for name, source in (revised or {}).items() if name not in given}
    resolved = ResolvedInputs(stays, files_in(stays))
    lookup = _Lookup(session, owner, kind.name, allowed, resolved.file_ids)
    there = {name for name, value in given.items() if value} | set(stays)
    errors = _erased(lookup, stays)
    offered = {item.name: item for item in kind.inputs}
    for name in given:
        if name not in offered:
            names = ", ".join(offered)
            errors.append(
                _error(name, "unknown_input", f"{kind.name} has no input “{name[:80]}”; it has {names}.", place)
            )
    for item in kind.inputs:
        try:
            source = _source(lookup, item, given.get(item.name))
            if source is not None:
                resolved.sources[item.name] = source
            elif item.needed(chosen, there) and item.name not in resolved.sources:
                detail = f"The input “{item.name}” is missing: {item.description}"
                by_option = revised is not None and item.name not in given  # the one that makes it needed was changed
                at = (str(item.spared_by), "/options") if by_option else (item.name, place)
                errors.append(_error(at[0], "missing_input", detail, at[1]))
        except ValueRefused as refused:
            errors.append(_error(item.name, refused.code, refused.detail, place))
    if errors:
        raise Problem(422, errors[0].code, errors[0].detail, errors)
    return resolved


def named_options(session: Session, owner: str, kind: Kind, given: dict[str, Value]) -> dict[str, str]:
    """Of what is given, the names of something built in (`Input.named_by`): the options that they stand for. They are
    nothing that an input is read from: `given` has null in their place. What the owner keeps under such a name goes
    before it."""
    names = {}
    for item in kind.inputs:
        value = given.get(item.name)
        if item.named_by is None or item.library is None or not isinstance(value, str):
            continue
        library = LIBRARIES[item.library]
        if value in library.built_in and kept.get(session, library, owner, value) is None:
            names[item.named_by] = value
            given[item.name] = None
    return names


def split_corrections(kind: Kind, corrections: Mapping[str, object]) -> tuple[dict[str, object], dict[str, Value]]:
    """Those corrections that are options, and those that are inputs. Raises a 422 problem."""
    inputs = {item.name for item in kind.inputs if item.corrects}
    options: dict[str, object] = {}
    given: dict[str, Value] = {}
    for name, value in corrections.items():
        if name not in inputs:
            if name not in kind.correctable:
                names = ", ".join(correctable(kind)) or "nothing"
                raise _refused(name, "unknown_correction", f"{kind.name} lets {names} be corrected.")
            options[name] = value
            continue
        try:
            given[name] = _VALUE_ADAPTER.validate_python(value)
        except ValidationError:
            detail = f"“{name}” is a file: give its id, an address, or null."
            raise _refused(name, "invalid_request", detail) from None
    return options, given


def correctable(kind: Kind) -> list[str]:
    """The names of all that a revision may correct: options, then inputs."""
    return [*kind.correctable, *(item.name for item in kind.inputs if item.corrects)]


def _refused(name: str, code: str, detail: str) -> Problem:
    return Problem(422, code, detail, [_error(name, code, detail, "/corrections")])


def files_in(sources: Mapping[str, Any]) -> set[str]:
    """The ids of all files that a job reads from."""
    found: set[str] = set()
    for source in sources.values():
        for one in source if isinstance(source, list) else [source]:
            found |= files_in(one["candidates"]) if "candidates" in one else {one["file"]} if "file" in one else set()
    return found


def _source(lookup: _Lookup, item: Input, value: Value) -> Any:
    if value is None or value == []:
        return None
    if isinstance(value, list) and not item.many:
        if len(value) != 1:
            raise ValueRefused("too_many_files", f"The input “{item.name}” takes one file.")
        value = value[0]
    if isinstance(value, list):
        return [_one(lookup, item, one) for one in value]
    return [_one(lookup, item, value)] if item.many else _one(lookup, item, value)


def _one(lookup: _Lookup, item: Input, value: str) -> dict[str, Any]:
    session, owner = lookup.session, lookup.owner
    library = LIBRARIES[item.library] if item.library is not None else None
    if library is not None and item.auto and value == AUTO_CHOICE:
        return _candidates(lookup, library)
    if "://" in value:
        return _address(item, value, lookup.allowed)
    file_id = value
    if not is_id(value):
        if library is None:
            raise ValueRefused("unknown_file", f"“{item.name}” is not the id of a file: upload it first.")
        own = kept.get(session, library, owner, value)
        if own is None:
            if value not in library.built_in or item.named_by is not None:
                detail = f"There is no {library.noun} “{value[:80]}”: GET {library.address} lists them."
                raise ValueRefused(f"unknown_{library.noun}", detail)
            return {"library": item.library, "name": value}
        file_id = own.file_id
    if item.artifact is not None and (found := _earlier_job(lookup, item.name, value, item.artifact)) is not None:
        return found
    file = held_file(session, owner, file_id, item.name)
    require_media(item, file.content_type)
    lookup.used.add(file.id)
    return {"file": file.id}


def _earlier_job(lookup: _Lookup, name: str, job_id: str, artifact: str) -> dict[str, str] | None:
    """The artifact of an earlier job as a source; None where the owner has no job of this id."""
    job = jobs.get(lookup.session, job_id)
    if job is None or job.owner != lookup.owner:
        return None
    if job.kind != lookup.kind:
        raise ValueRefused(
            "job_of_other_kind", f"“{name}” takes a job of the kind {lookup.kind}; this is a {job.kind}."
        )
    if job.status != Status.SUCCEEDED or artifacts.get(lookup.session, job_id, artifact) is None:
        detail = f"“{name}” takes a job that has succeeded and left {artifact}; this one is {job.status}."
        raise ValueRefused("job_not_succeeded", detail)
    return {"job": job_id, "artifact": artifact}


def _erased(lookup: _Lookup, sources: Mapping[str, Any]) -> list[FieldError]:
    """Of what a revision would read again, what was erased with the job that made it."""
    made = {name: one for name, one in sources.items() if isinstance(one, dict) and "job" in one}
    return [
        _error(name, "input_erased", f"The job that “{name}” was taken from was erased, and all of it.")
        for name, one in made.items()
        if artifacts.get(lookup.session, one["job"], one["artifact"]) is None
    ]


def held_file(session: Session, owner: str, file_id: str, what: str) -> File:
    """The owner's file, which nobody erases until this transaction ends. Raises `ValueRefused`."""
    file = files.get_locked(session, owner, file_id)
    if file is None:
        if (upload := uploads.get(session, owner, file_id)) is not None:
            come = f"{upload.received} of {upload.length or 'unknown'} bytes have come"
            raise ValueRefused("upload_unfinished", f"The upload {file_id} for “{what}” is not finished: {come}.")
        raise ValueRefused(
            "unknown_file", f"There is no file {file_id[:80]} for “{what}”: it was erased, or never was."
        )
    return file


def _address(item: Input, url: str, allowed: Sequence[Network]) -> dict[str, str]:
    """An address that the worker fetches. Only what can be seen of it is judged here."""
    try:
        require_callable(url, allowed)
    except AddressRefused as refused:
        raise ValueRefused("input_url_refused", f"“{item.name}”: {refused}") from refused
    return {"url": url}


def require_media(item: Input, content_type: str) -> None:
    """Raise `ValueRefused` if an input cannot be of this media type."""
    if item.media in MEDIA_TYPES and content_type not in MEDIA_TYPES[item.media]:
        raise ValueRefused("input_wrong_media", f"“{item.name}” must be of type {item.media}; this is {content_type}.")


def _candidates(lookup: _Lookup, library: Library) -> dict[str, Any]:
    """What `auto` chooses from: the built-in library, then what the user keeps beside it, the newest first."""
    candidates: dict[str, dict[str, str]] = {one: {"library": library.name, "name": one} for one in library.built_in}
    own = kept.with_files(lookup.session, library, lookup.owner)
    for one, _ in sorted(own, key=lambda pair: pair[0].created_at, reverse=True)[:MAX_OWN_CANDIDATES]:
        if (file := files.get_locked(lookup.session, lookup.owner, one.file_id)) is not None:
            candidates[one.name] = {"file": file.id}
            lookup.used.add(file.id)
    return {"candidates": candidates}


def _error(name: str, code: str, detail: str, place: str = "/inputs") -> FieldError:
    return FieldError(pointer=f"{place}/{name}", code=code, detail=detail)
