"""By what words a job is found: its title, its kind, the names of its files, and those of its drivers and motions.

They are kept with the job, in one case and one form of Unicode: databases fold the letters of few languages.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Mapping
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from engine.kind import Kind
from service.ids import is_id
from service.tables.files import File
from service.tables.jobs import Job


def fold_text(text: str) -> str:
    """A text in which case and ways of writing the same letter make no difference."""
    return unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", text).casefold())


def search_words(query: str) -> list[str]:
    """What must all be found, in any order and anywhere."""
    return fold_text(query).split()


def describe(session: Session, job: Job, kind: Kind) -> None:
    """Note by what words a new job is found; its title, kind, inputs and options are there."""
    ids = [value for value in _values(job.inputs) if is_id(value)]
    names = session.scalars(select(File.name).where(File.id.in_(ids), File.owner == job.owner)).all()
    given = [value for value in _values(job.inputs) if not is_id(value)]
    built_in = [str(job.options[item.named_by]) for item in kind.inputs if item.named_by in job.options]
    job.search = _text(job.title, [job.kind, *names, *given, *built_in])


def retitle(job: Job, title: str | None) -> None:
    """Give a job another title, or none."""
    job.title = title
    job.search = "\n".join([_line(title or ""), *job.search.split("\n")[1:]])


def _values(inputs: Mapping[str, Any]) -> list[str]:
    return [one for value in inputs.values() for one in (value if isinstance(value, list) else [value])]


def _text(title: str | None, names: Iterable[str]) -> str:
    """One line for the title, and one for each name."""
    return "\n".join(_line(name) for name in (title or "", *names))


def _line(text: str) -> str:
    return " ".join(fold_text(text).split())
