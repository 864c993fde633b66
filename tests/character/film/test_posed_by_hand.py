"""Poses set by hand: on the ground."""

from __future__ import annotations

import numpy as np
import pytest
from template_character import still, template_character

from engine.character.film.motions import posed_by_hand
from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character

CROUCHED = {f"{side}{joint}": (turn, 0.0, 0.0) for side in ("Left", "Right")
            for joint, turn in (("UpLeg", -60.0), ("Leg", 110.0), ("Foot", -50.0))}  # fmt: skip
TIPTOE = {f"{side}Foot": (40.0, 0.0, 0.0) for side in ("Left", "Right")}


@pytest.fixture(scope="module")
def character() -> Character:
    mesh = template_character(texture_size=16)
    return Character(mesh, still(mesh.skeleton), np.array([0.0, 1.0, 4.0]))


@pytest.mark.parametrize(("turned", "way"), [(CROUCHED, -1), (TIPTOE, 1), ({"LeftUpLeg": (-80.0, 0.0, 0.0)}, 0)])
def test_who_is_posed_stands_on_the_ground_on_which_they_stood(
    character: Character, turned: dict[str, tuple[float, float, float]], way: int
) -> None:
    posed = posed_by_hand(character, turned)
    before, after = (pose(character, clip)[:, 1].min() for clip in (character.pictured, posed))
    assert after == pytest.approx(before, abs=1e-5)
    rises = float(posed.root[0, 1] - character.pictured.root[0, 1])
    assert rises * way > 0.05 if way else abs(rises) < 0.01, "on one leg it is as high as on two"
    np.testing.assert_array_equal(posed.root[0, [0, 2]], character.pictured.root[0, [0, 2]])


def test_a_pose_of_the_arms_leaves_the_feet_where_they_are(character: Character) -> None:
    posed = posed_by_hand(character, {"LeftArm": (0.0, 0.0, 60.0)})
    np.testing.assert_array_equal(posed.root, character.pictured.root)
