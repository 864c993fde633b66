"""What a frame is asked about, and what not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine.avatar.texture.view_samples import sample_views
from tests.avatar.texture.conftest import Ball, ring


def test_what_is_too_far_from_the_camera_is_not_taken(ball: Ball) -> None:
    camera = ring(1)[0]
    view = ball.view(camera)
    whole, near = (sample_views(ball.surface, [each]).cosine[:, 0] > 0 for each in (view, replace(view, farthest=3.2)))
    depths = camera.depth(ball.surface.vertices[ball.surface.triangles].mean(1))
    np.testing.assert_array_equal(near, whole & (depths < 3.2))
    assert near.sum() < 0.8 * whole.sum()


def test_what_is_beside_the_outline_of_the_person_is_not_taken(ball: Ball) -> None:
    camera = ring(1)[0]
    x = np.arange(camera.size[1])
    half = np.broadcast_to(x < 100, camera.size)
    view = replace(ball.view(camera), person=lambda: half)
    taken = sample_views(ball.surface, [view]).cosine[:, 0] > 0
    pixels = camera.project(ball.surface.vertices[ball.surface.triangles[taken]].mean(1))
    assert 90 < pixels[:, 0].max() < 99
