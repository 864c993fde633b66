"""Who can be filmed."""

from __future__ import annotations

from benchmarks.scan_studio.people.scanned_people import RIGGED_PEOPLE, UNRIGGED_PEOPLE, read_subject
from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.people.template_people import TEMPLATE_LOOKS, template_subject
from benchmarks.shared_media import media

SUBJECTS = (*RIGGED_PEOPLE, *UNRIGGED_PEOPLE, *TEMPLATE_LOOKS)


def subject_named(name: str) -> Subject:
    """The subject of this name, at rest. Raises KeyError where there is none."""
    return template_subject(name) if name in TEMPLATE_LOOKS else read_subject(name, media("scans3d"))
