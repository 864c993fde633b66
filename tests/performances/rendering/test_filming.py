"""Frames of a performance: where it is lit in full, that what lies between looks as if it were, and that the shipped
ones are of this studio."""

from __future__ import annotations

import numpy as np
import pytest

from engine.media.video import read_video
from engine.performances import video
from engine.performances.modelling.actor import Actor, build_actor, stage
from engine.performances.modelling.figure import Pose
from engine.performances.rendering.filming import MAX_KEY_FRAME_DISTANCE, MAX_POSE_CHANGES, carry, key_frames
from engine.performances.rendering.lighting import lamps
from engine.performances.rendering.studio import HAIR_LAMPS, expose, finish, photograph
from engine.performances.scores.score import SCORES


@pytest.fixture(scope="module")
def actor() -> Actor:
    return build_actor(lamps(HAIR_LAMPS))


def test_frames_between_key_frames_look_as_if_lit_in_full(actor: Actor) -> None:
    """Three moments of a smile: the middle one carries the light of the others, and is what the studio would make."""
    poses = [SCORES["happy"](t) for t in (0.60, 0.68, 0.76)]
    first, last = (expose(actor, stage(actor, poses[i]), detail=0.3) for i in (0, 2))
    between = carry(first, last, 0.5, stage(actor, poses[1]))
    assert between is not None
    made = finish(between, actor).astype(float)
    full = photograph(actor, stage(actor, poses[1]), detail=0.3).astype(float)
    away = np.abs(made - full)
    assert away.mean() < 0.8 and np.quantile(away, 0.99) < 12
    assert away.mean() < 0.3 * np.abs(finish(first, actor) - full).mean()


def test_the_shipped_videos_are_what_the_studio_makes(actor: Actor) -> None:
    """The first frame, rendered anew: whoever changes the actor has to render the videos again."""
    shipped = next(iter(read_video(video("surprise")))).rgb
    fresh = photograph(actor, stage(actor, Pose())).astype(float)
    assert np.abs(fresh - shipped).mean() < 1.5


def test_key_frames_stand_where_much_changes() -> None:
    still = [Pose() for _ in range(20)]
    assert key_frames(still) == [0, MAX_KEY_FRAME_DISTANCE, 19]
    turning = [Pose(head=(0.0, 2.0 * i, 0.0)) for i in range(20)]
    keys = key_frames(turning)
    assert keys[0] == 0 and keys[-1] == 19
    assert max(np.diff(keys)) * 2.0 <= MAX_POSE_CHANGES["head"] + 2.0
