"""A face at rest told by one picture of an expression: of faces that were made, and of an actor who is known at rest."""

from __future__ import annotations

import numpy as np

from engine.media.video import read_video
from engine.perception.expression.features import frontalise
from engine.perception.face.faces import FaceTracker
from engine.perception.face.head_pose import canonical_face
from engine.performances import video
from engine.persona.motion.estimated_rest import estimated_rest
from engine.persona.motion.mesh_units import load_mesh_units


def root_mean_square(apart: np.ndarray) -> float:
    return float(np.sqrt((apart**2).mean()))


def test_the_general_face_is_at_rest() -> None:
    general = frontalise(canonical_face()[None].astype(float))[0]
    np.testing.assert_allclose(estimated_rest(general), general, atol=1e-3)


def test_what_units_make_of_it_is_taken_away() -> None:
    units, general = load_mesh_units(), frontalise(canonical_face()[None].astype(float))[0]
    for names in (("jawOpen",), ("mouthSmileLeft", "mouthSmileRight"), ("browInnerUp", "jawOpen")):
        moved = sum(units.moved[units.names.index(name)] for name in names)
        found = estimated_rest(general + moved)
        assert root_mean_square(found - general) < 0.4 * root_mean_square(moved), names


def test_no_more_is_taken_away_than_a_face_can_do() -> None:
    """Of what goes thrice as far as a unit, the rest is how this person looks."""
    units, general = load_mesh_units(), frontalise(canonical_face()[None].astype(float))[0]
    moved = units.moved[units.names.index("jawOpen")]
    left = ((estimated_rest(general + 3 * moved) - general) * moved).sum() / (moved**2).sum()
    assert 1.7 < left < 2.1


def test_an_actor_who_laughs_is_told_nearer_to_how_he_is_at_rest() -> None:
    frames = [frame.rgb for frame in read_video(video("surprise-strong"))]
    with FaceTracker(alone=True) as tracker:
        rest, shown = (frontalise(tracker(frames[number])[0][None])[0] for number in (0, len(frames) // 2))
    assert root_mean_square(estimated_rest(shown) - rest) < 0.5 * root_mean_square(shown - rest)
