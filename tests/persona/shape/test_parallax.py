"""Depth of a face that turns, of faces whose depth is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.geometry.registration.rigid import fit_similarity
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LEFT_EYE, LEFT_IRIS
from engine.persona.shape.parallax import depth_by_parallax, face_by_parallax
from engine.persona.texture.texture_frame import TextureFrame, texture_frame, with_rim

NOSE_TIP = 4
PHOTO_PIXELS_PER_EYE_DISTANCE = 60.0


def turned(count: int, degrees: float) -> np.ndarray:
    """(N, 3, 3) heads that look about."""
    angles = np.random.default_rng(3).uniform(-degrees, degrees, (count, 2)) * (0.5, 1)
    return Rotation.from_euler("xy", angles, degrees=True).as_matrix()


def error(face: np.ndarray, true: np.ndarray) -> float:
    """Mean distance in depth, eye distances, once the face is laid on the true one."""
    return float(np.abs(fit_similarity(face, true)(face) - true)[:, 2].mean())


@pytest.fixture(scope="module")
def usual() -> np.ndarray:
    return canonical_face().astype(np.float64)


@pytest.fixture(scope="module")
def own(usual: np.ndarray) -> np.ndarray:
    """A face with a longer nose and deeper eyes than the usual one."""
    away = np.zeros(len(usual))
    for middle, deeper in ((NOSE_TIP, -0.12), (159, 0.06), (386, 0.06)):
        away += deeper * np.exp(-((usual[:, :2] - usual[middle, :2]) ** 2).sum(1) / (2 * 0.15**2))
    return usual + away[:, None] * (0, 0, 1)


def test_a_longer_nose_is_told_by_photographs_of_turned_heads(usual: np.ndarray, own: np.ndarray) -> None:
    places = 80 * np.einsum("nij,vj->nvi", turned(60, 25)[:, :2], own) + 200
    found = face_by_parallax(usual, places, np.ones(places.shape[:2]))
    assert error(found, own) < 0.5 * error(usual, own)
    assert found[NOSE_TIP, 2] < usual[NOSE_TIP, 2] - 0.08
    np.testing.assert_allclose(fit_similarity(found, usual).matrix(), np.eye(3, 4), atol=1e-9)


def test_one_wrong_photograph_in_ten_changes_little(usual: np.ndarray, own: np.ndarray) -> None:
    places = 80 * np.einsum("nij,vj->nvi", turned(60, 25)[:, :2], own) + 200
    places[::10, ::3] += np.random.default_rng(5).normal(size=places[::10, ::3].shape) * 12
    found = face_by_parallax(usual, places, np.ones(places.shape[:2]))
    assert error(found, own) < 0.5 * error(usual, own)


def test_where_nothing_is_trusted_it_is_the_usual_face(usual: np.ndarray, own: np.ndarray) -> None:
    places = 80 * np.einsum("nij,vj->nvi", turned(20, 25)[:, :2], own) + 200
    trust = np.ones(places.shape[:2])
    trust[:, :100] = 0
    found = face_by_parallax(usual, places, trust)
    assert np.abs(found - usual)[:100].max() < 0.02 < np.abs(found - usual)[100:].max()


@pytest.fixture(scope="module")
def frame(usual: np.ndarray) -> TextureFrame:
    return texture_frame(usual, (244, 194))


def test_points_are_led_to_where_photographs_show_them(frame: TextureFrame, usual: np.ndarray, own: np.ndarray) -> None:
    turns = turned(40, 20)
    meshes, offsets = [], []
    for turn in turns:  # the tracker has the usual face, the photographs show the person's
        meshes.append(usual @ turn.T * PHOTO_PIXELS_PER_EYE_DISTANCE + 150)
        off = np.linalg.solve(turn[:2, :2], ((own - usual) @ turn.T)[:, :2].T).T
        offsets.append(frame.interpolated(with_rim(off) * frame.scale))
    belief = np.ones((len(turns), *frame.size))
    found = depth_by_parallax(frame, np.array(meshes), np.array(offsets), belief)
    wanted = (own - usual)[:, 2]
    assert np.corrcoef(found[:468], wanted[:468])[0, 1] > 0.93
    assert found[NOSE_TIP] < 0.6 * wanted[NOSE_TIP]
    assert np.ptp(found[list(LEFT_IRIS)]) == 0 and found[LEFT_IRIS[0]] == pytest.approx(found[list(LEFT_EYE)].mean())
    unmoved = depth_by_parallax(frame, np.array(meshes), np.zeros_like(offsets), belief)
    assert np.abs(unmoved).max() < 0.01, "where the tracker is right nothing is changed"


def test_what_a_turned_head_hides_tells_nothing(frame: TextureFrame, usual: np.ndarray) -> None:
    turns = Rotation.from_euler("y", np.full((12, 1), 70), degrees=True).as_matrix()
    meshes = usual @ np.swapaxes(turns, 1, 2) * PHOTO_PIXELS_PER_EYE_DISTANCE + 150
    hidden = frame.facing(turns[0]) == 0
    offsets = np.zeros((len(turns), *frame.size, 2))
    offsets[:, hidden] = 3
    assert hidden[frame.face].mean() > 0.2
    found = depth_by_parallax(frame, meshes, offsets, np.ones((len(turns), *frame.size)))
    assert np.abs(found).max() < 0.06, "eye distances"
