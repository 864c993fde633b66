"""Landmarks that several cameras see."""

from __future__ import annotations

import numpy as np
import pytest

from engine.avatar.landmarks.detection import spatial_landmarks
from engine.avatar.landmarks.in_frames import FrameLandmarks, reliable
from engine.avatar.landmarks.robust_triangulation import triangulate_robustly
from engine.geometry.camera import Camera
from engine.perception.pose.body import BODY_LANDMARKS, Body


def _ring(count: int) -> list[Camera]:
    lens = Camera((0.0, 0.0, 0.0), 900.0, (359.5, 639.5), (1280, 720))
    turns = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return [lens.aimed((2.4 * np.sin(turn), 1.2, 2.4 * np.cos(turn)), (0, 1, 0)) for turn in turns]


def test_views_that_agree_outvote_those_that_are_wrong() -> None:
    cameras, place = _ring(12), np.array([0.4, 1.3, 0.1])
    random = np.random.default_rng(1)
    pixels = np.stack([camera.project(place)[:2] for camera in cameras]) + random.normal(0, 2, (12, 2))
    pixels[[1, 5, 6, 9]] = random.uniform(0, 700, (4, 2))
    found = triangulate_robustly(cameras, pixels, np.ones(12), np.full(12, 6.0))
    assert found is not None
    assert np.linalg.norm(found.place - place) < 0.006  # 2 pixels are 5 mm there
    assert found.agreeing == 8


def test_a_place_that_more_views_agree_on_is_believed() -> None:
    """Five of twelve views have the other hand."""
    cameras, place, other = _ring(12), np.array([0.4, 1.3, 0.1]), np.array([-0.4, 1.1, 0.1])
    pixels = np.stack(
        [camera.project(other if k % 12 in (0, 2, 5, 7, 9) else place)[:2] for k, camera in enumerate(cameras)]
    )
    found = triangulate_robustly(cameras, pixels, np.ones(12), np.full(12, 6.0))
    assert found is not None and found.agreeing == 7
    np.testing.assert_allclose(found.place, place, atol=1e-3)


def test_a_pixel_of_a_near_view_counts_more_than_one_of_a_far_view() -> None:
    """Two views a metre away and two ten metres away have places that are 4 mm apart: a third of a pixel far away, and 3.6 near by."""
    near, other = np.array([0.0, 1.0, 0.0]), np.array([0.0, 1.004, 0.0])
    lens = _ring(1)[0]
    eyes = [(0, 1, 1), (1, 1, 0), (0, 1, -10), (-10, 1, 0)]
    cameras = [lens.aimed(eye, near) for eye in eyes]
    pixels = np.stack([camera.project(near if k < 2 else other)[:2] for k, camera in enumerate(cameras)])
    found = triangulate_robustly(cameras, pixels, np.ones(4), np.full(4, 100.0))
    assert found is not None
    np.testing.assert_allclose(found.place, near + (other - near) / 101, atol=2e-5)  # weights are 1 and 1/100


def test_parallel_lines_of_sight_meet_nowhere() -> None:
    cameras = [_ring(12)[0]] * 3
    assert triangulate_robustly(cameras, np.full((3, 2), 300.0), np.ones(3), np.full(3, 6.0)) is None


def test_landmarks_need_three_views() -> None:
    cameras = _ring(6)
    places = {"Nose": np.array([0, 1.6, 0.1]), "LeftKnee": np.array([0.1, 0.5, 0.0])}
    seen = []
    for k, camera in enumerate(cameras):
        named = {name: (camera.project(at)[:2].astype(np.float64), 0.9) for name, at in places.items()}
        if k > 1:
            del named["Nose"]
        seen.append((camera, FrameLandmarks(named, None)))
    found = spatial_landmarks(seen)
    assert set(found.body) == {"LeftKnee"}
    assert np.allclose(found.body["LeftKnee"], places["LeftKnee"], atol=1e-4)
    assert np.isnan(found.face).all()


@pytest.mark.parametrize(("names", "best", "kept"), [(13, 0.9, 33), (13, 0.4, 0), (5, 0.9, 0)])
def test_skeletons_of_few_bones_or_low_confidence_are_dropped(names: int, best: float, kept: int) -> None:
    """As section 3.3: fewer than four bones, or a best confidence below one half. The face alone has no bone."""
    confidence = np.full(33, best, np.float32)
    if names == 5:
        confidence[11:] = 0.1
    body = Body(np.zeros((33, 2), np.float32), np.zeros((33, 3), np.float32), confidence)
    found = reliable(body)
    assert len(found) == kept
    assert set(found) <= set(BODY_LANDMARKS)
