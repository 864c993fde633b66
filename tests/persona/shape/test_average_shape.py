"""Shape from photographs in unknown light, on faces whose shape is known."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.perception.face.head_pose import canonical_face
from engine.persona.shape.average_shape import average_depth
from engine.persona.shape.photometric_stereo import photometric_stereo
from engine.persona.shape.screened_poisson import screened_poisson
from engine.persona.texture.appearance_subspace import Appearance
from engine.persona.texture.texture_frame import TextureFrame, texture_frame

SIZE = (244, 194)


def slopes_of(depth: np.ndarray) -> np.ndarray:
    """(H, W, 2) the rises to the next pixels."""
    out = np.zeros((*depth.shape, 2))
    out[:, :-1, 0], out[:-1, :, 1] = np.diff(depth, axis=1), np.diff(depth, axis=0)
    return out


def normals_of(depth: np.ndarray) -> np.ndarray:
    """(H, W, 3) x right, y down, z away, of a surface whose depth goes away from the viewer."""
    below, right = np.gradient(depth)
    found = np.stack([right, below, -np.ones_like(depth)], -1)
    return found / np.linalg.norm(found, axis=-1, keepdims=True)


def lit(depth: np.ndarray, count: int, albedo: np.ndarray) -> np.ndarray:
    """(N, H, W) greys of a surface under a light each, and what comes from all around."""
    random = np.random.default_rng(4)
    lights = random.normal(size=(count, 3)) * [0.25, 0.25, 0.05] - [0, 0, 0.5]
    shade = np.einsum("hwc,nc->nhw", normals_of(depth), lights) + random.uniform(0.4, 0.6, count)[:, None, None]
    return (albedo * shade).astype(np.float32)


def test_a_surface_comes_back_from_its_slopes_and_a_hint() -> None:
    depth = cv2.GaussianBlur(np.random.default_rng(0).normal(size=(60, 47)), (0, 0), 4) * 30
    np.testing.assert_allclose(screened_poisson(slopes_of(depth), depth, 1e-3), depth, atol=1e-9)
    offset = screened_poisson(slopes_of(depth), np.full(depth.shape, 5.0), 1e-9)
    np.testing.assert_allclose(offset - offset.mean(), depth - depth.mean(), atol=1e-4)
    assert offset.mean() == pytest.approx(5.0)


def test_slopes_over_the_rim_do_not_count() -> None:
    depth = cv2.GaussianBlur(np.random.default_rng(0).normal(size=(30, 23)), (0, 0), 4) * 30
    slopes = slopes_of(depth)
    slopes[:, -1, 0], slopes[-1, :, 1] = 7, -9
    np.testing.assert_allclose(screened_poisson(slopes, depth, 1e-3), depth, atol=1e-9)


def test_without_slopes_what_is_near_is_smoothed() -> None:
    near = np.zeros((40, 40))
    near[20, 20] = 1
    found = screened_poisson(np.zeros((40, 40, 2)), near, 0.1)
    assert found.sum() == pytest.approx(1) and 0 < found[20, 22] < found[20, 21] < found[20, 20] < 0.2


def test_normals_are_found_under_unknown_lights_by_another_faces() -> None:
    ys, xs = np.mgrid[-1:1:80j, -1:1:64j]
    usual = 20 * (xs**2 + ys**2)
    own = usual + cv2.GaussianBlur(np.random.default_rng(1).normal(size=usual.shape), (0, 0), 4) * 8
    albedo = 160 + 40 * np.sin(9 * xs) * np.sin(7 * ys)
    greys = lit(own, 25, albedo)
    area = np.ones(usual.shape, np.bool_)
    found = photometric_stereo(Appearance(greys, greys, np.ones_like(greys)), normals_of(usual), area, area)
    error = [
        np.degrees(np.arccos(np.clip((one * normals_of(own)).sum(-1), -1, 1))).mean()
        for one in (normals_of(usual), found.normals)
    ]
    assert error[1] < 0.35 * error[0], "degrees"
    assert np.corrcoef(found.albedo.ravel(), albedo.ravel())[0, 1] > 0.97


@pytest.fixture(scope="module")
def frame() -> TextureFrame:
    return texture_frame(canonical_face(), SIZE)


def test_what_shading_shows_is_added_to_the_meshs_depth(frame: TextureFrame) -> None:
    bumps = np.zeros(SIZE)
    for x, y, height in ((60, 150, 2.5), (135, 150, 2.5), (97, 55, -2.0)):
        bumps[y, x] = height * 2 * np.pi * 5**2
    bumps = cv2.GaussianBlur(bumps, (0, 0), 5)
    mesh = frame.interpolated(frame.places[:, 2:])[..., 0].astype(float)
    plain, bumpy = (
        average_depth(frame, Appearance(greys, greys, np.ones_like(greys)))
        for greys in (lit(depth, 40, np.full(SIZE, 180.0)) for depth in (mesh, mesh - bumps))
    )
    found = plain - bumpy  # towards the viewer
    inner = cv2.erode(frame.face.astype(np.uint8), np.ones((25, 25))) > 0
    assert np.corrcoef(found[inner], bumps[inner])[0, 1] > 0.85
    assert 0.35 < found[150, 60] / bumps[150, 60] < 1.2, "what is as wide as the mesh tells is taken from the mesh"
    assert np.abs(found[~frame.face]).max() < 0.5, "the rim stays where the mesh has it"
