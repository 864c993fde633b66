"""A known texture, filmed and stitched: it comes back where it was seen, whatever the exposure, the lens and the strips."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.avatar.texture.stitching import StitchedTexture, stitch_texture
from engine.avatar.texture.views import FrameView
from engine.geometry.camera import Camera
from engine.render.rasterisation.attributes import interpolate
from engine.render.textures.texture_bake import texel_raster
from tests.avatar.texture.conftest import Ball, known_colours, ring

SIZE = 256
DRIFT = 0.15


def drift(count: int) -> NDArray:
    """Gains, of mean 1 in logarithms, that differ from frame to frame."""
    wave = DRIFT * np.sin(1.7 * np.arange(count))
    return np.asarray(np.exp(wave - wave.mean()))


@pytest.fixture(scope="module")
def drifting(ball: Ball, ball_cameras: list[Camera]) -> StitchedTexture:
    gains = drift(len(ball_cameras))
    views = [ball.view(camera, gain=gain) for camera, gain in zip(ball_cameras, gains, strict=True)]
    return stitch_texture(ball.surface, views, SIZE)


def test_what_was_seen_comes_back_in_the_mean_exposure(ball: Ball, drifting: StitchedTexture) -> None:
    away = np.abs(drifting.texture.astype(float) - known_colours(ball, SIZE))[drifting.seen]
    assert drifting.seen[drifting.raster.triangle >= 0].mean() > 0.97
    assert away.mean() < 3 and np.quantile(away, 0.99) < 14


def test_gains_undo_the_drift(drifting: StitchedTexture) -> None:
    left = drifting.gains * drift(len(drifting.gains))[:, None]
    assert np.abs(left - 1).max() < 0.01


def test_without_its_gains_the_same_film_shows_its_drift(ball: Ball, drifting: StitchedTexture) -> None:
    """The drift is large enough for the tests above to mean something."""
    gains = drift(len(drifting.gains))[drifting.labels.labels]
    assert np.abs(gains - 1).mean() > 0.05


def test_what_no_frame_shows_is_filled_smoothly(ball: Ball) -> None:
    def grey(points: NDArray) -> NDArray:
        return np.repeat(128 + 60 * points[..., 1:2], 3, -1)

    found = stitch_texture(ball.surface, [ball.view(camera, grey) for camera in ring(6)], SIZE)
    hole = (found.raster.triangle >= 0) & ~found.seen
    places = interpolate(ball.surface.vertices, ball.surface.triangles, texel_raster(ball.surface.atlas, SIZE))
    assert (np.abs(places[hole][:, 1]) > 0.7).all() and hole.sum() > 500
    seen = found.texture[found.seen]
    assert found.texture[hole].min() >= seen.min() - 1 and found.texture[hole].max() <= seen.max() + 1
    assert np.abs(found.texture.astype(float) - grey(places))[hole].mean() < 15


def test_pixels_beside_the_person_give_nothing(ball: Ball) -> None:
    """The surface is 5% larger than what was filmed: at its outline frames show the wall behind."""
    views = []
    for camera in ring(5):
        near = replace(camera, focal=camera.focal * 0.95)
        picture = ball.picture(near)
        mask = (picture != 250).any(2)
        views.append(FrameView(camera, lambda p=picture: p, lambda m=mask: m))
    found = stitch_texture(ball.surface, views, SIZE)
    assert not (found.texture[found.seen] == 250).all(1).any()


def test_the_lens_is_undone(ball: Ball) -> None:
    bent = [replace(camera, distortion=(-0.25, 0.05, 0.002, -0.001)) for camera in ring(4)]
    found = stitch_texture(ball.surface, [ball.view(camera) for camera in bent], SIZE)
    assert np.abs(found.texture.astype(float) - known_colours(ball, SIZE))[found.seen].mean() < 3


def test_the_resolution_is_that_of_both_directions_in_the_mean(ball: Ball) -> None:
    """What is seen aslant is as fine along its edge as from before, and as much coarser across it as it is foreshortened."""
    camera = ring(1)[0]
    found = stitch_texture(ball.surface, [ball.view(camera)], SIZE)
    middles = ball.surface.vertices[ball.surface.triangles].mean(1)
    towards = np.asarray(camera.eye) - middles
    cosine = (middles * towards).sum(1) / np.linalg.norm(middles, axis=1) / np.linalg.norm(towards, axis=1)
    shown = found.resolution > 0
    expected = camera.focal / camera.depth(middles) * np.sqrt(np.maximum(cosine, 0))
    assert shown.sum() > 300 and cosine[shown].min() < 0.5
    np.testing.assert_allclose(found.resolution[shown], expected[shown], rtol=0.05)


def test_views_that_miss_the_surface_are_refused(ball: Ball) -> None:
    away = ring(1)[0].aimed([0, 0, 4], [0, 0, 8])
    with pytest.raises(ValueError, match="no view shows"):
        stitch_texture(ball.surface, [ball.view(away)], SIZE)
