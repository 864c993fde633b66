"""Frames that show the surface elsewhere than their cameras have it are laid onto each other."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.avatar.texture.alignment import MAX_SHIFT_SIDES, aligned
from engine.avatar.texture.view_samples import sample_views
from engine.avatar.texture.views import FrameView
from engine.geometry.camera import Camera
from engine.render.rasterisation.visibility import view_cosines
from tests.avatar.texture.conftest import Ball, ring, waves

SIDE = 200


def cameras() -> list[Camera]:
    return [*ring(8, size=SIDE), *ring(3, height=2.5, size=SIDE)]


def drifted(picture: NDArray[np.uint8], number: int) -> NDArray[np.uint8]:
    """A picture whose places are smoothly moved by up to 4 pixels, each time otherwise."""
    y, x = np.mgrid[:SIDE, :SIDE].astype(np.float32)
    across = 4 * np.sin(number * 2.1) * np.cos(y / 60)
    down = 4 * np.cos(number * 1.3) * np.cos(x / 60)
    there = (x + across.astype(np.float32), y + down.astype(np.float32))
    return np.asarray(cv2.remap(picture, *there, cv2.INTER_LINEAR, borderValue=250), np.uint8)


def disagreement(ball: Ball, views: list[FrameView]) -> float:
    """Grey levels by which frames differ, in the mean, where two or more show an edge."""
    samples = sample_views(ball.surface, views)
    seen = np.all((samples.cosine > 0)[samples.pairs], axis=1)
    shown = seen & (seen.sum(axis=1, keepdims=True) > 1)
    colours = np.where(shown[:, :, None, None], samples.colours.astype(float), np.nan)[np.any(shown, axis=1)]
    return float(np.nanmean(np.nanstd(colours, axis=1)))


@pytest.fixture(scope="module")
def drifting(ball: Ball) -> list[FrameView]:
    pictures = [drifted(ball.picture(camera), number) for number, camera in enumerate(cameras())]
    return [
        FrameView(camera, partial(np.asarray, picture)) for camera, picture in zip(cameras(), pictures, strict=True)
    ]


def test_frames_agree_once_they_are_shifted(ball: Ball, drifting: list[FrameView]) -> None:
    found = list(aligned(ball.surface, drifting, np.ones((len(drifting), 3))))
    exact = disagreement(ball, [ball.view(camera) for camera in cameras()])
    before, after = disagreement(ball, drifting), disagreement(ball, found)
    print(f"{exact:.2f} by design, {before:.2f} before, {after:.2f} after")
    assert before > 4 and after < exact + 0.1 * (before - exact)


def moved(ball: Ball, view: FrameView) -> NDArray[np.float32]:
    """(N, 2) pixels by which those vertices are shifted that are seen from not too far aside."""
    assert view.shift is not None
    front = view_cosines(view.camera, ball.surface.vertices, ball.surface.vertices) > 0.5
    places = view.camera.project(ball.surface.vertices[front])
    return (view.shift.shifted(places) - places)[:, :2]


def test_what_is_right_stays(ball: Ball) -> None:
    views = [ball.view(camera) for camera in cameras()[:4]]
    for view in aligned(ball.surface, views, np.ones((len(views), 3))):
        assert np.abs(moved(ball, view)).max() < 0.6


def test_where_nothing_tells_it_does_not_move(ball: Ball) -> None:
    views = [ball.view(camera, lambda points: np.full_like(points, 128)) for camera in cameras()[:3]]
    for view in aligned(ball.surface, views, np.ones((len(views), 3))):
        assert view.shift is not None and np.abs(view.shift.nodes).max() < 0.5


def test_a_frame_that_shows_something_else_moves_no_further_than_is_allowed_and_no_other(ball: Ball) -> None:
    views = [ball.view(camera) for camera in cameras()]
    views[3] = ball.view(cameras()[3], lambda points: waves(1.7 * points + 0.4))
    found = aligned(ball.surface, views, np.ones((len(views), 3)))
    assert found[3].shift is not None and np.abs(found[3].shift.nodes).max() <= MAX_SHIFT_SIDES * SIDE + 1e-3
    for number in {*range(len(views))} - {3}:
        assert np.median(np.abs(moved(ball, found[number]))) < 0.3


def test_the_outline_is_drawn_onto_a_surface_that_stands_out(ball: Ball) -> None:
    """The surface is 11% larger than what was filmed, and all of one colour: only masks tell."""
    views = []
    for camera in cameras()[:3]:
        near = replace(camera, focal=camera.focal * 0.9)
        mask = np.any(ball.picture(near) != 250, axis=2)
        views.append(FrameView(camera, partial(np.full, (SIDE, SIDE, 3), 128, np.uint8), partial(np.asarray, mask)))
    found = aligned(ball.surface, views, np.ones((len(views), 3)))
    seen = [(sample_views(ball.surface, each).cosine > 0).sum() for each in (views, found)]
    assert seen[1] > seen[0]
