"""Frames that show something else than most do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine.avatar.texture.photo_consistency import consistent
from engine.avatar.texture.stitching import stitch_texture
from engine.avatar.texture.view_samples import sample_views
from engine.avatar.texture.views import FrameView
from engine.geometry.camera import Camera
from tests.avatar.texture.conftest import Ball, known_colours

SIZE = 256
RUG = (230, 20, 20)


def with_rug(view: FrameView, camera: Camera) -> FrameView:
    """The frame with a red patch before a part of the ball."""
    picture = view.picture()
    height, width = camera.size
    picture[height // 2 : height // 2 + 40, width // 2 - 20 : width // 2 + 20] = RUG
    return replace(view, read=lambda: picture)


def test_what_one_frame_shows_beside_all_others_is_not_taken(ball: Ball, ball_cameras: list[Camera]) -> None:
    views = [ball.view(camera) for camera in ball_cameras]
    spoilt = [with_rug(views[0], ball_cameras[0]), *views[1:]]
    found = stitch_texture(ball.surface, spoilt, SIZE)
    away = np.abs(found.texture.astype(float) - known_colours(ball, SIZE))[found.seen]
    assert np.quantile(away, 0.995) < 25  # the patch would be two in a hundred of all
    assert found.seen[found.raster.triangle >= 0].mean() > 0.995


def test_frames_that_agree_are_all_kept_and_so_is_what_few_show(ball: Ball, ball_cameras: list[Camera]) -> None:
    views = [ball.view(camera) for camera in ball_cameras]
    samples = sample_views(ball.surface, views)
    ones = np.ones((len(views), 3), np.float32)
    kept = consistent(samples, ones).cosine > 0
    assert kept[samples.cosine > 0].mean() > 0.99
    two = sample_views(ball.surface, [with_rug(views[0], ball_cameras[0]), views[1]])
    np.testing.assert_array_equal(consistent(two, ones[:2]).cosine, two.cosine)


def test_where_frames_are_doubted_what_few_show_is_not_taken(ball: Ball, ball_cameras: list[Camera]) -> None:
    views = [ball.view(camera) for camera in ball_cameras[:2]]
    samples = sample_views(ball.surface, views)
    doubted = ball.surface.vertices[ball.surface.triangles].mean(1)[:, 1] > 0
    found = consistent(samples, np.ones((2, 3), np.float32), doubted).cosine
    assert not found[doubted].any() and samples.cosine[doubted].any()
    np.testing.assert_array_equal(found[~doubted], samples.cosine[~doubted])
