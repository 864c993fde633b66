"""Eyes, teeth and lids."""

from __future__ import annotations

import numpy as np
import pytest
from known_person import KnownPerson
from scipy.spatial.transform import Rotation

from engine.avatar.registration.face_parts import lids_on_eyes, place_parts, sphere
from engine.avatar.registration.models import HumanModels


@pytest.mark.parametrize("part", ["left_eye", "upper_teeth", "tongue"])
def test_parts_go_with_a_head_that_is_moved_turned_and_grown(
    models: HumanModels, person: KnownPerson, part: str
) -> None:
    turn = 1.07 * Rotation.from_rotvec([0.1, 0.2, -0.1]).as_matrix()
    moved = person.vertices @ turn.T + [0.1, 0, 0.2]
    placed = place_parts(models.template, models.skin, person.vertices, moved[models.skin.vertices])
    at = models.template.vertices_of(part)
    assert np.allclose(placed[at], moved[at], atol=1e-6)


def test_lids_end_before_the_eyeball(models: HumanModels, person: KnownPerson) -> None:
    template, skin = models.template, models.skin
    vertices = person.vertices.copy()
    eye = template.vertices_of("left_eye")
    vertices[eye] += [0, 0, 0.004]
    middle, radius = sphere(vertices[eye])
    fitted = lids_on_eyes(template, skin, vertices)
    lids = fitted[skin.regions["lids"] & ~skin.regions["inner"]]
    near = np.linalg.norm(lids - middle, axis=1)
    assert (np.linalg.norm(vertices[skin.vertices][skin.regions["lids"]] - middle, axis=1) < radius).any()
    assert near.min() > radius


def test_the_sphere_through_points() -> None:
    random = np.random.default_rng(2).normal(size=(40, 3))
    points = [0.1, 0.2, 0.3] + 0.012 * random / np.linalg.norm(random, axis=1, keepdims=True)
    middle, radius = sphere(points)
    assert np.allclose(middle, [0.1, 0.2, 0.3])
    assert radius == pytest.approx(0.012)
