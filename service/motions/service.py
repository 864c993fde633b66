"""What clients can see of motions; keeping and erasing them is as with all that is kept (`service.kept`)."""

from __future__ import annotations

from engine.motion.catalogue import CATALOGUE
from service.context import Context
from service.kept import repository
from service.kept.looks import looks_into
from service.kept.service import file_of, missing
from service.kept.shelves import MOTIONS
from service.motions.checks import Check
from service.motions.schemas import MotionOut
from service.problems import Problem
from service.tables.stored import Stored


def all_motions(context: Context, owner: str) -> list[MotionOut]:
    """The built-in motions and the user's own; one that was kept before there was a built-in one of its name goes
    before it."""
    with context.database.read() as session:
        own = repository.with_files(session, MOTIONS, owner)
    found = looks_into(context, MOTIONS, Check, [motion for motion, _ in own])
    hidden = {motion.name for motion, _ in own}
    built_in = [MotionOut.built_in(one) for one in CATALOGUE if one.name not in hidden]
    return [*built_in, *(MotionOut.own(motion, file, found[motion.name]) for motion, file in own)]


def one_motion(context: Context, owner: str, name: str) -> MotionOut:
    """The motion of that name."""
    for motion in all_motions(context, owner):
        if motion.name == name:
            return motion
    raise missing(MOTIONS)


def stored(context: Context, owner: str, name: str) -> Stored:
    """The file of one of the user's own motions."""
    file = file_of(context, MOTIONS, owner, name)
    if file is not None:
        return file.stored
    if name in MOTIONS.built_in:
        raise Problem(404, "motion_without_file", "A built-in motion has no file: it is made for each character.")
    raise missing(MOTIONS)
