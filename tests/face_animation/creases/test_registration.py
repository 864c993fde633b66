"""Meshes brought back onto the skin: a shift that the tracker did not see is measured and taken in."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from made_face import SKIN, driver, opened, placed
from numpy.typing import NDArray

from engine.face_animation.creases.registration import register_track
from engine.perception.face.landmarks import FACE_OVAL, LIPS_INNER, LIPS_OUTER, RIGHT_EYE
from engine.perception.face_track.face_crop import CROP_SHAPE
from engine.perception.face_track.track import FaceTrack

FACE = placed(70, (100, 100))
CHEEKS = [50, 205, 280, 425, 36, 266]
SHIFT = np.array([2.0, -1.5])
"""Pixels of the crop."""


def skin() -> NDArray[np.uint8]:
    """Skin with pores and freckles, so that it can be followed."""
    rng = np.random.default_rng(0)
    fine = sum(a * cv2.GaussianBlur(rng.normal(0, 1, CROP_SHAPE), (0, 0), s) * s for a, s in ((6, 2.0), (10, 5.0)))
    return np.clip(np.array(SKIN) + 3 * np.asarray(fine)[..., None], 0, 255).astype(np.uint8)


def moved(picture: NDArray[np.uint8], shift: NDArray) -> NDArray[np.uint8]:
    matrix = np.column_stack([np.eye(2), shift])
    return np.asarray(
        cv2.warpAffine(picture, matrix, CROP_SHAPE[::-1], flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE),
        np.uint8,
    )


@pytest.fixture(scope="module")
def slipped(tmp_path_factory) -> FaceTrack:
    """The skin has moved in the later frames, the tracker's mesh has not."""
    pictures = [skin()] * 6 + [moved(skin(), SHIFT)] * 6
    return driver(tmp_path_factory.mktemp("slipped"), [FACE] * 12, pictures)


def test_the_skin_s_shift_is_found(slipped: FaceTrack) -> None:
    found = register_track(slipped, 0).meshes - slipped.meshes
    scale = float(np.linalg.norm(slipped.crop_places[0][:, 0]))
    np.testing.assert_allclose(found[9, CHEEKS, :2] * scale, np.broadcast_to(SHIFT, (6, 2)), atol=0.4)
    assert np.abs(found[2, CHEEKS, :2] * scale).max() < 0.2


def test_lids_lips_and_depth_stay_as_tracked(slipped: FaceTrack) -> None:
    found = register_track(slipped, 0).meshes
    for contour in (RIGHT_EYE, LIPS_INNER):
        np.testing.assert_allclose(found[:, list(contour)], slipped.meshes[:, list(contour)], atol=1e-3)
    np.testing.assert_allclose(found[..., 2], slipped.meshes[..., 2], atol=1e-3)


def test_the_red_of_lips_that_are_open_at_rest_stays_as_tracked(tmp_path: Path) -> None:
    """The flow takes teeth that come and go for lips that move."""
    smile = opened(FACE, 0.3)
    track = driver(tmp_path, [smile] * 6, [skin()] * 3 + [moved(skin(), SHIFT)] * 3)
    lips, points = track.in_crop(0)[list(LIPS_OUTER)], track.in_crop(0)[:468]
    within = [v for v, at in enumerate(points) if cv2.pointPolygonTest(lips, at.tolist(), False) >= 0]
    assert len(within) > len(LIPS_OUTER + LIPS_INNER)
    found = register_track(track, 0).meshes
    np.testing.assert_array_equal(found[:, within], track.meshes[:, within])
    assert np.abs(found[5, CHEEKS, :2] - track.meshes[5, CHEEKS, :2]).max() > 0.4


def test_what_stays_as_tracked_is_not_steadied_once_more(tmp_path: Path) -> None:
    """The track was steadied when it was made: a second time would shift the moment at which a mouth is widest."""
    rng = np.random.default_rng(1)
    jittered = [FACE + rng.normal(0, 0.3, FACE.shape).astype(np.float32) for _ in range(12)]
    track = driver(tmp_path, jittered, [skin()] * 12)
    found = register_track(track, 0).meshes
    for contour in (RIGHT_EYE, LIPS_INNER, FACE_OVAL):
        np.testing.assert_array_equal(found[:, list(contour)], track.meshes[:, list(contour)])
    np.testing.assert_array_equal(found[..., 2], track.meshes[..., 2])


def test_a_true_track_is_left_alone(tmp_path: Path) -> None:
    """Also in other light: it is made equal before the flow is measured."""
    dark = np.clip(skin() * np.linspace(0.7, 1.0, CROP_SHAPE[1])[None, :, None], 0, 255).astype(np.uint8)
    track = driver(tmp_path, [FACE] * 6, [skin()] * 3 + [dark] * 3)
    found = register_track(track, 0).meshes - track.meshes
    inner = [v for v in CHEEKS if v not in FACE_OVAL]
    assert np.abs(found[:, inner, :2]).max() < 0.4


def test_it_tells_how_far_it_is(slipped: FaceTrack) -> None:
    seen: list[float] = []
    register_track(slipped, 0, seen.append)
    assert seen == sorted(seen) and seen[-1] == 1.0 and len(seen) == len(slipped)


def test_the_contour_stays_as_tracked(slipped: FaceTrack) -> None:
    """Beyond it the flow sees what lies behind the face, and vertices beside each other would part."""
    found = register_track(slipped, 0).meshes
    np.testing.assert_allclose(found[:, list(FACE_OVAL)], slipped.meshes[:, list(FACE_OVAL)], atol=1e-3)
