"""The depth of a painted sphere is measured as it is."""

import numpy as np
from textured_sphere import CENTRE, RADIUS, picture, ring, seen_depth, seen_points

from engine.geometry.multiview.patch_match_stereo import StereoView, patch_match_stereo

CAMERAS = ring(24)
SOURCES = (1, 2, 22, 23)


def view(number: int) -> StereoView:
    camera = CAMERAS[number]
    return StereoView(picture(camera), seen_depth(camera) > 0, camera)


def reach(number: int) -> np.ndarray:
    """(H, W, 2) from 10 cm before the sphere to 30 cm behind its front, for all its pixels alike."""
    depth = seen_depth(CAMERAS[number])
    front = depth[depth > 0].min()
    return np.where(depth[..., None] > 0, [front - 0.1, front + 0.3], 0).astype(np.float32)


def test_depth_and_normals_are_the_spheres() -> None:
    measured = patch_match_stereo(view(0), [view(s) for s in SOURCES], reach(0))
    depth = seen_depth(CAMERAS[0])
    inner = np.linalg.norm(np.indices(depth.shape) - 59.5, axis=0) < 30  # of about 43 pixels
    error = np.abs(measured.depth - depth)[inner]
    assert np.median(error) < 0.002  # a pixel is 6 mm wide there
    assert np.quantile(error, 0.9) < 0.008
    normals = (seen_points(CAMERAS[0]) - CENTRE) / RADIUS
    cosine = (measured.normals * normals).sum(axis=-1)[inner]
    assert np.median(cosine) > np.cos(np.radians(12))
    assert np.median(measured.cost[inner]) < 0.1


def test_nothing_is_measured_beside_the_figure() -> None:
    measured = patch_match_stereo(view(0), [view(s) for s in SOURCES], reach(0), levels=1)
    assert (measured.depth[seen_depth(CAMERAS[0]) == 0] == 0).all()


def test_a_view_whose_sources_show_something_else_tells_it_by_its_cost() -> None:
    others = [view(s) for s in (10, 11, 12, 13)]  # from behind
    measured = patch_match_stereo(view(0), others, reach(0), levels=1)
    inner = np.linalg.norm(np.indices(measured.depth.shape) - 59.5, axis=0) < 30
    assert np.median(measured.cost[inner]) > 0.3


def test_the_same_seed_measures_the_same() -> None:
    first, again = (patch_match_stereo(view(0), [view(1), view(23)], reach(0), seed=4) for _ in "ab")
    assert (first.depth == again.depth).all()
