"""Teeth and tongue."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson
from scipy.spatial.transform import Rotation

from engine.avatar.registration.face.face_parts import MOUTH_PARTS, TEETH_DEPTH, place_parts
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels
from engine.geometry.closest_points import closest_points
from engine.geometry.winding_number import winding_numbers


@pytest.mark.parametrize("part", ["upper_teeth", "tongue"])
def test_parts_go_with_a_head_that_is_moved_turned_and_grown(
    models: HumanModels, person: KnownPerson, part: str
) -> None:
    turn = 1.07 * Rotation.from_rotvec([0.1, 0.2, -0.1]).as_matrix()
    moved = person.vertices @ turn.T + [0.1, 0, 0.2]
    placed = place_parts(models.template, models.skin, person.vertices, moved[models.skin.vertices])
    at = models.template.vertices_of(part)
    assert np.allclose(placed[at], moved[at], atol=1e-6)


def test_teeth_are_behind_the_lips_in_both_poses(models: HumanModels, fitted: FittedTemplate) -> None:
    template, skin = models.template, models.skin
    inside = np.concatenate([template.vertices_of(part) for part in MOUTH_PARTS])
    for vertices in (fitted.vertices, fitted.rest.astype(np.float64)):
        own, hull = vertices[skin.vertices], skin.triangles[skin.visible]
        assert winding_numbers(vertices[inside], own, hull).min() > 0.5
        assert closest_points(vertices[inside], own, hull).distance.min() > TEETH_DEPTH - 1e-5


def test_teeth_that_would_stick_out_are_set_back(models: HumanModels, person: KnownPerson) -> None:
    template, skin = models.template, models.skin
    lean = person.vertices[skin.vertices].copy()
    teeth = person.vertices[template.vertices_of("upper_teeth")]
    near = np.linalg.norm(lean - teeth.mean(0), axis=1) < 0.06
    lean[near & (lean[:, 2] > teeth[:, 2].max() - 0.003)] -= [0, 0, 0.006]  # the mouth fallen in
    placed = place_parts(template, skin, person.vertices, lean)
    at = template.vertices_of("upper_teeth")
    assert winding_numbers(placed[at], lean, skin.triangles[skin.visible]).min() > 0.5
