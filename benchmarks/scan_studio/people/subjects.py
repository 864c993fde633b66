"""Who can be filmed."""

from __future__ import annotations

from benchmarks.scan_studio.people.bearded import with_beard
from benchmarks.scan_studio.people.scanned_people import RIGGED_PEOPLE, UNRIGGED_PEOPLE, read_subject
from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.people.template_people import TEMPLATE_LOOKS, template_subject
from benchmarks.shared_media import media

BEARDED_PEOPLE = {"template-bearded": "template-a"}
"""Who has a beard, and on whom it grows."""
SUBJECTS = (*RIGGED_PEOPLE, *UNRIGGED_PEOPLE, *TEMPLATE_LOOKS, *BEARDED_PEOPLE)


def subject_named(name: str) -> Subject:
    """The subject of this name, at rest. Raises KeyError where there is none."""
    if name in BEARDED_PEOPLE:
        return with_beard(template_subject(BEARDED_PEOPLE[name]), name)
    return template_subject(name) if name in TEMPLATE_LOOKS else read_subject(name, media("scans3d"))
