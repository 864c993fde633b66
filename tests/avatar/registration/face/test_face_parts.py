"""Teeth and tongue."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson
from scipy.spatial.transform import Rotation

from engine.avatar.registration.face.face_parts import (
    MOUTH_PARTS,
    SHOWN_INCISORS_METRES,
    TEETH_DEPTH_METRES,
    TONGUE_BELOW_INCISORS_METRES,
    head_change,
    place_parts,
)
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import triangulate
from engine.geometry.mesh.winding_number import winding_numbers
from engine.render.rasterisation.rasteriser import depth_map


@pytest.mark.parametrize("part", ["upper_teeth", "tongue"])
def test_parts_go_with_a_head_that_is_moved_turned_and_grown(
    models: HumanModels, person: KnownPerson, part: str
) -> None:
    turn = 1.07 * Rotation.from_rotvec([0.1, 0.2, -0.1]).as_matrix()
    moved = person.vertices @ turn.T + [0.1, 0, 0.2]
    own, placed = (
        place_parts(models.template, models.skin, person.vertices, whole[models.skin.vertices])
        for whole in (person.vertices, moved)
    )
    at = models.template.vertices_of(part)
    away = placed[at] - (own[at] @ turn.T + [0.1, 0, 0.2])  # all alike: lips are as far before teeth of any size
    assert np.ptp(away, axis=0).max() < 1e-6
    assert np.linalg.norm(away[0]) < 0.0025


def test_upper_incisors_end_below_where_the_lips_meet(models: HumanModels, fitted: FittedTemplate) -> None:
    template, skin = models.template, models.skin
    own = template.vertices[skin.vertices].astype(np.float64)
    back = head_change(skin, own, fitted.rest[skin.vertices].astype(np.float64)).inverse()
    teeth = back(fitted.rest[template.vertices_of("upper_teeth")].astype(np.float64))
    lips = back(fitted.rest[skin.vertices[skin.face_points[[62, 66]]]].astype(np.float64)).mean(0)
    front = teeth[:, 2] > teeth[:, 2].max() - 0.015
    assert teeth[front, 1].min() - lips[1] == pytest.approx(-SHOWN_INCISORS_METRES, abs=0.0015)


@pytest.mark.parametrize(
    "units", [{"mouthSmileLeft": 1.0, "mouthSmileRight": 1.0}, {"mouthFunnel": 1.0}, {"mouthShrugLower": 1.0}]
)
def test_no_tooth_comes_through_skin_that_is_pressed_against_it(
    models: HumanModels, fitted: FittedTemplate, units: dict[str, float]
) -> None:
    template, skin = models.template, models.skin
    vertices = fitted.rest.astype(np.float64)
    vertices = vertices + sum(weight * fitted.expressions[name] for name, weight in units.items())
    parts = triangulate(template.quads[template.faces(*MOUTH_PARTS)]).astype(np.int32)
    hull = skin.vertices[skin.triangles[skin.visible & skin.regions["face"][skin.triangles].all(1)]].astype(np.int32)
    middle = vertices[skin.vertices[skin.face_points[48:68]]].mean(0)
    seen = ((vertices - middle) * [1, 1, -1] / 0.0005 + [100, 100, 0]).astype(np.float32)
    face, teeth = (depth_map(seen, triangles, (200, 200)) for triangles in (hull, parts))
    both = np.isfinite(face) & np.isfinite(teeth)
    assert both.sum() > 5000
    assert (teeth[both] - face[both]).min() > 0


def test_teeth_are_behind_the_lips_in_both_poses(models: HumanModels, fitted: FittedTemplate) -> None:
    template, skin = models.template, models.skin
    inside = np.concatenate([template.vertices_of(part) for part in MOUTH_PARTS])
    for vertices in (fitted.vertices, fitted.rest.astype(np.float64)):
        own, hull = vertices[skin.vertices], skin.triangles[skin.visible]
        assert winding_numbers(vertices[inside], own, hull).min() > 0.5
        assert closest_points(vertices[inside], own, hull).distance.min() > TEETH_DEPTH_METRES - 1e-5


def test_teeth_that_would_stick_out_are_set_back(models: HumanModels, person: KnownPerson) -> None:
    template, skin = models.template, models.skin
    lean = person.vertices[skin.vertices].copy()
    teeth = person.vertices[template.vertices_of("upper_teeth")]
    near = np.linalg.norm(lean - teeth.mean(0), axis=1) < 0.06
    lean[near & (lean[:, 2] > teeth[:, 2].max() - 0.003)] -= [0, 0, 0.006]  # the mouth fallen in
    placed = place_parts(template, skin, person.vertices, lean)
    at = template.vertices_of("upper_teeth")
    assert winding_numbers(placed[at], lean, skin.triangles[skin.visible]).min() > 0.5


def test_a_tongue_lies_below_the_edge_of_the_lower_incisors(models: HumanModels, person: KnownPerson) -> None:
    template, skin = models.template, models.skin
    own, fitted = template.vertices[skin.vertices].astype(np.float64), person.vertices[skin.vertices]
    upright = place_parts(template, skin, person.vertices, fitted) @ head_change(skin, own, fitted).rotation
    tongue, teeth = (upright[template.vertices_of(part)] for part in ("tongue", "lower_teeth"))
    tip, incisors = (part[part[:, 2] > part[:, 2].max() - 0.012] for part in (tongue, teeth))
    assert tip[:, 1].max() - incisors[:, 1].max() == pytest.approx(-TONGUE_BELOW_INCISORS_METRES, abs=0.0015)
