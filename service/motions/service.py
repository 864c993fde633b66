"""What clients can see of motions; keeping and erasing them is as with all that is kept (`service.keeping`)."""

from __future__ import annotations

from engine.motion.catalogue import CATALOGUE
from service.context import Context
from service.keeping.presentation import Presentation
from service.keeping.service import file_of, not_found_problem
from service.libraries.library import MOTION_LIBRARY
from service.motions.checks import Check
from service.motions.schemas import MotionOut
from service.problems import Problem
from service.tables.stored import Stored


def _built_in() -> list[MotionOut]:
    return [MotionOut.built_in(motion) for motion in CATALOGUE]


PRESENTED_MOTIONS = Presentation(MOTION_LIBRARY, Check, _built_in, MotionOut.own)


def stored(context: Context, owner: str, name: str) -> Stored:
    """The file of one of the user's own motions."""
    file = file_of(context, MOTION_LIBRARY, owner, name)
    if file is not None:
        return file.stored
    if name in MOTION_LIBRARY.built_in:
        raise Problem(404, "motion_without_file", "A built-in motion has no file: it is made for each character.")
    raise not_found_problem(MOTION_LIBRARY)
