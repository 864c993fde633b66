"""Which frames faces take: the most frontal, the finest, and steep ones where there is no other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.labels import UNSEEN_LABEL, best_views, stitched
from engine.avatar.texture.view_samples import ViewSamples, sample_views
from engine.avatar.texture.views import FrameView
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import triangle_areas
from tests.avatar.texture.conftest import Ball, ring


def looked_at(ball: Ball, cameras: list[Camera]) -> tuple[ViewSamples, NDArray, NDArray]:
    areas = triangle_areas(ball.surface.vertices, ball.surface.triangles)
    return sample_views(ball.surface, [ball.view(each) for each in cameras]), np.ones((len(cameras), 3)), areas


def patches(points: NDArray) -> NDArray:
    """Plain grounds with sharp borders: seams can run where frames agree."""
    return np.asarray(128 + 80 * np.sign(np.sin(np.asarray(points) * 9 + [0, 1, 2])))


def middles(ball: Ball) -> NDArray:
    return np.asarray(ball.surface.vertices[ball.surface.triangles].mean(1))


def test_of_frames_from_as_far_the_most_frontal_is_best(ball: Ball) -> None:
    cameras = ring(8)
    found = best_views(*looked_at(ball, cameras))
    seen = np.flatnonzero((found.labels != UNSEEN_LABEL) & (np.abs(middles(ball)[:, 1]) < 0.3))
    angle = np.arctan2(middles(ball)[seen, 0], middles(ball)[seen, 2])
    nearest = np.round(angle / (np.pi / 4)).astype(int) % 8
    assert len(seen) > 1000 and (found.labels[seen] == nearest).mean() > 0.97


def test_a_frame_from_near_wins_by_its_finer_pixels(ball: Ball) -> None:
    far, near = ring(1, distance=6.0)[0], ring(1, distance=2.5)[0]
    samples, gains, areas = looked_at(ball, [far, near])
    for found in (best_views(samples, gains, areas), stitched(samples, gains, areas)):
        both = (samples.cosine > np.cos(np.radians(45))).all(1)
        assert both.sum() > 100 and (found.labels[both] == 1).all()


def test_steep_frames_serve_where_there_is_no_other(ball: Ball) -> None:
    samples, gains, areas = looked_at(ball, ring(1))
    found = stitched(samples, gains, areas)
    back = np.array([0, 0, 4.0]) - middles(ball)
    degrees = np.degrees(np.arccos((back * middles(ball)).sum(1) / np.linalg.norm(back, axis=1) / 0.999))
    assert (found.labels[degrees < 60] == 0).all()
    assert (found.labels[degrees > 68] == UNSEEN_LABEL).all()


def test_where_frames_disagree_labels_avoid_seams(ball: Ball, ball_cameras: list[Camera]) -> None:
    """The ball is filmed from elsewhere than the cameras say, by about as much as a person sways."""
    random = np.random.default_rng(3)
    views = []
    for camera in ball_cameras:
        x, y, z = np.array(camera.eye) + random.normal(0, 0.04, 3)
        picture = ball.picture(replace(camera, eye=(x, y, z)), patches)
        views.append(FrameView(camera, lambda p=picture: p))
    gains = np.ones((len(views), 3))
    areas = triangle_areas(ball.surface.vertices, ball.surface.triangles)
    samples = sample_views(ball.surface, views)
    best, found = best_views(samples, gains, areas), stitched(samples, gains, areas)
    assert found.data + 4 * found.seams < best.data + 4 * best.seams
    assert found.seams < 0.6 * best.seams
    assert found.data >= best.data


def test_faces_that_are_not_stitched_take_nothing_and_hide_what_is_behind(ball: Ball) -> None:
    half = ball.surface.stitched & (middles(ball)[:, 2] < 0)
    bare = type(ball.surface)(ball.surface.vertices, ball.surface.triangles, ball.surface.atlas, half)
    samples = sample_views(bare, [ball.view(each) for each in ring(4)])
    assert not samples.cosine[~half].any()
    assert not samples.cosine[:, 0].any()
    assert samples.cosine[:, 2].any()
