"""Views that suit a landmark, and where their lines of sight meet a cloud."""

from __future__ import annotations

import numpy as np
import pytest

from engine.avatar.landmarks.back_projection import MAX_LANDMARK_DISTANCE_METRES, back_projected, completed, onto_cloud
from engine.avatar.landmarks.in_frames import FrameLandmarks
from engine.avatar.landmarks.landmark_views import chosen_views, frontality, most_frontal
from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.geometry.camera import Camera
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import fiducials

FACE = fiducials(canonical_face().astype(np.float64) @ np.diag([1.0, -1.0, -1.0])) * 0.06 + [0, 1.6, 0.1]
PLACES = {
    "Nose": (0.0, 1.58, 0.12),
    "MouthLeft": (0.03, 1.52, 0.1),
    **{f"{side}{name}": (sign * x, y, z) for side, sign in (("Left", 1), ("Right", -1)) for name, x, y, z in (
        ("Ear", 0.08, 1.6, 0), ("Shoulder", 0.18, 1.4, 0), ("Hip", 0.1, 0.9, 0), ("Index", 0.5, 0.9, 0.03),
        ("Heel", 0.12, 0.04, -0.06), ("FootIndex", 0.14, 0.02, 0.16),
    )},
}  # fmt: skip
"""A person who stands and looks along z; their left is at positive x."""
TURNS = (0, 40, 90, 140, 185, 230, 270, 320)
"""Degrees round to their left from which they are seen: from the front, from behind about, and from both sides."""


def _view(degrees: float) -> tuple[Camera, FrameLandmarks]:
    turn = np.deg2rad(degrees)
    lens = Camera((0.0, 0.0, 0.0), 1100.0, (359.5, 639.5), (1280, 720))
    camera = lens.aimed((2 * np.sin(turn), 1.2, 2 * np.cos(turn)), (0, 0.9, 0))

    def seen(points: np.ndarray) -> np.ndarray:
        return camera.project(np.asarray(points, np.float64), np.float64)[..., :2]

    body = {}
    for name, at in PLACES.items():
        near = np.sign(at[0]) * np.sin(turn)
        body[name] = seen(np.array(at)), 0.7 + 0.25 * float(near)
    return camera, FrameLandmarks(body, seen(FACE) if np.cos(turn) > 0.3 else None)


@pytest.fixture(scope="module")
def views() -> list[tuple[Camera, FrameLandmarks]]:
    return [_view(degrees) for degrees in TURNS]


def test_each_landmark_is_looked_at_from_where_it_shows(views: list[tuple[Camera, FrameLandmarks]]) -> None:
    chosen = {name: TURNS[view] for name, view in chosen_views([found for _, found in views]).items()}
    assert chosen["Nose"] == chosen["MouthLeft"] == 0
    assert chosen["LeftEar"] == chosen["LeftIndex"] == 90
    assert chosen["RightEar"] == chosen["RightIndex"] == 270
    assert chosen["LeftHeel"] == chosen["RightHeel"] == 185
    assert not {"LeftShoulder", "RightHip", "LeftFootIndex"} & chosen.keys()


def test_a_face_is_most_frontal_from_the_front(views: list[tuple[Camera, FrameLandmarks]]) -> None:
    frames = [found for _, found in views]
    assert most_frontal(frames) == 0
    assert most_frontal(frames[2:7]) is None
    front, aside = frames[0].face, frames[1].face
    assert front is not None
    assert aside is not None
    assert frontality(front) == pytest.approx(frontality(front * 3 + 10))
    assert frontality(front) > frontality(aside) + 0.05


def test_a_line_of_sight_ends_at_the_first_surface() -> None:
    x, y = np.meshgrid(np.linspace(-0.3, 0.3, 151), np.linspace(0.6, 1.2, 151))
    front, back = (np.column_stack([x.ravel(), y.ravel(), np.full(x.size, z)]) for z in (0.1, -0.1))
    camera = Camera((0.0, 0.0, 0.0), 1100.0, (359.5, 639.5), (1280, 720)).aimed((0.4, 1.1, 2), (0, 0.9, 0))
    true = np.array([[0.11, 0.83, 0.1], [-0.2, 1.1, 0.1]])
    pixels = camera.project(true, np.float64)[:, :2]
    found = onto_cloud(camera, np.concatenate([pixels, [[5.0, 5.0]]]), np.concatenate([back, front]))
    assert np.abs(found[:2] - true).max() < 0.002
    assert np.isnan(found[2]).all()


def test_landmarks_lie_on_the_cloud_that_has_them(views: list[tuple[Camera, FrameLandmarks]]) -> None:
    random = np.random.default_rng(0)
    wanted = np.concatenate([FACE, [PLACES["LeftIndex"], PLACES["RightHeel"]]])
    cloud = (wanted[:, None] + random.normal(0, 0.0015, (len(wanted), 12, 3))).reshape(-1, 3)
    found = back_projected(views, cloud)
    for name in ("LeftIndex", "RightHeel"):
        assert np.linalg.norm(found.body[name] - PLACES[name]) < 0.004
    assert "LeftEar" not in found.body  # of which the cloud has nothing
    assert np.nanmedian(np.linalg.norm(found.face - FACE, axis=1)) < 0.004


def test_one_view_is_believed_where_it_is_surer_and_not_far_from_the_others() -> None:
    at = np.array([0.0, 1.0, 0.0])
    ahead = np.array([0.0, 0.0, MAX_LANDMARK_DISTANCE_METRES])
    near, far = at + ahead / 2, at + 2 * ahead
    face = np.full((68, 3), np.nan)
    face[:2] = at
    projected = face.copy()
    projected[:3] = near, far, near
    many = SpatialLandmarks({"Nose": at, "LeftIndex": at, "RightIndex": at, "LeftEar": at, "LeftKnee": at}, face)
    one = SpatialLandmarks({"Nose": near, "LeftIndex": far, "LeftEar": near, "RightHeel": far}, projected)
    both = completed(many, one)
    taken = {name for name, place in both.body.items() if place is one.body.get(name)}
    assert taken == {"Nose", "RightHeel"}
    assert both.body.keys() == many.body.keys() | {"RightHeel"}
    np.testing.assert_array_equal(both.face[:3], [near, at, near])
    assert np.isnan(both.face[3:]).all()
