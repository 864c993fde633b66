"""The mouth's inside goes with its rim."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from known_person import KnownPerson

from engine.avatar.registration.face.inner_mouth import brought_inside, inner_skin
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.lip_contact import closed_mouth
from engine.geometry.mesh.winding_number import winding_numbers


def test_what_is_not_seen_goes_with_what_is(models: HumanModels, person: KnownPerson) -> None:
    before = person.vertices[models.skin.vertices]
    inner = models.skin.regions["inner"]
    after = before + np.array([0.01, -0.02, 0.03])
    after[inner] += np.random.default_rng(0).normal(0, 0.02, (inner.sum(), 3))  # whatever the fit made of it
    found = inner_skin(models.skin, before, after)
    assert np.array_equal(found[~inner], after[~inner])
    off = np.linalg.norm(found[inner] - before[inner] - [0.01, -0.02, 0.03], axis=1)
    assert np.median(off) < 1e-6


def test_nothing_of_the_inside_is_outside_of_a_face_that_has_fallen_in(
    models: HumanModels, person: KnownPerson
) -> None:
    skin = models.skin
    before = person.vertices[skin.vertices]
    nose = before[skin.face_points[33]]
    after = before.copy()
    after[:, 2] -= 0.008 * np.exp(-((np.linalg.norm(before - nose, axis=1) / 0.02) ** 2))
    found = inner_skin(skin, before, after)
    deep = skin.regions["inner"] & (np.linalg.norm(before - nose, axis=1) < 0.04)
    assert winding_numbers(found[deep], found, skin.triangles[skin.visible]).min() > 0.5


def test_what_is_less_deep_than_it_has_to_be_is_brought_so_deep_and_no_deeper() -> None:
    """In a ball of a decimetre: a point outside, one a tenth of a millimetre within, and one in the middle between."""
    ball = trimesh.creation.icosphere(5, 0.1)
    vertices, faces = np.asarray(ball.vertices, np.float64), np.asarray(ball.faces, np.int32)
    points = np.array([[0.11, 0, 0], [0.0999, 0, 0], [0.05, 0, 0]])
    found = brought_inside(points, vertices, faces, np.full(3, 0.002))
    np.testing.assert_allclose(found, [[0.098, 0, 0], [0.098, 0, 0], [0.05, 0, 0]], atol=2e-4)


@pytest.mark.parametrize("mouth", ["narrow", "pushed back"])
def test_the_inside_of_a_lip_does_not_hang_past_its_edge(models: HumanModels, mouth: str) -> None:
    """Lips touch, and what is behind the edge of one is near the other; as the mouth opens it showed as notches. From corner to
    corner, that is: there both edges end in one."""
    skin = models.skin
    inner, lips = skin.regions["inner"], {1: skin.regions["upper_lip"], -1: skin.regions["lower_lip"]}
    before = models.template.vertices[skin.vertices].astype(np.float64)
    middle = before[skin.face_points[[62, 66]]].mean(0)
    across = np.abs(before[:, 0]) / before[skin.face_points[54], 0]
    near = np.exp(-((np.linalg.norm(before - middle, axis=1) / 0.03) ** 2))
    after = closed_mouth(before, skin.triangles, skin.lip_contact, skin.regions["lips"] | inner)
    if mouth == "narrow":
        after = middle + (after - middle) * (1 - 0.3 * near[:, None])
    else:
        after[:, 2] -= 0.006 * near * lips[1] * np.clip(1 - across**2, 0, 1)  # at its corners it is the other's
    found = inner_skin(skin, before, after)
    for upwards, lip in lips.items():
        edge, inside = found[lip & ~inner], found[lip & inner & (across < 1)]
        beside = np.abs(inside[:, None, 0] - edge[None, :, 0]) < 0.002
        end = np.where(beside, upwards * edge[None, :, 1], np.inf).min(1)
        assert (upwards * inside[:, 1] > end).all()
