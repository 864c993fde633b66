"""The common face of photographs in different light, whatever covers some of them."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.persona.texture.appearance_subspace import EXPOSED_GREY, Appearance, appearance, exposed
from engine.persona.texture.dense_alignment import MAX_SHIFT, align_densely, shifted

SIZE = (122, 97)
AREA = np.zeros(SIZE, np.bool_)
AREA[4:-4, 4:-4] = True


def under_lights(count: int) -> np.ndarray:
    """A bumpy face of two colours under `count` lights: greys (N, H, W) that span four dimensions."""
    random = np.random.default_rng(1)
    ys, xs = np.mgrid[-1 : 1 : SIZE[0] * 1j, -1 : 1 : SIZE[1] * 1j]
    height = cv2.GaussianBlur(random.normal(size=SIZE), (0, 0), 6) * 20 + 2 - xs**2 - ys**2
    gradient = np.gradient(height, ys[1, 0] - ys[0, 0], xs[0, 1] - xs[0, 0])
    normal = np.stack([-gradient[1], -gradient[0], np.ones(SIZE)], -1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    albedo = 120 + 40 * np.sign(cv2.GaussianBlur(random.normal(size=SIZE), (0, 0), 4))
    lights = random.normal(size=(count, 3)) * 0.12 + [0, 0, 0.4]
    ambient = random.uniform(0.5, 0.7, count)
    shade = np.einsum("hwc,nc->nhw", normal, lights) + ambient[:, None, None]
    return (albedo * shade).astype(np.float32)


def plain(count: int) -> np.ndarray:
    return np.ones((count, *SIZE), np.float32) * AREA


def test_photographs_that_span_four_dimensions_are_their_own_projections() -> None:
    grey = exposed(under_lights(30), AREA)
    found = appearance(grey, plain(30), AREA)
    assert np.abs(found.projected - grey)[:, AREA].mean() < 0.1, "grey levels"
    assert found.weights[:, AREA].mean() > 0.999


def test_exposure_does_not_matter() -> None:
    grey = under_lights(10)
    np.testing.assert_allclose(exposed(grey * 0.4, AREA), exposed(grey, AREA), rtol=1e-5)
    assert exposed(grey, AREA)[:, AREA].mean(axis=1) == pytest.approx(np.full(10, EXPOSED_GREY), rel=1e-4)


def test_what_covers_a_face_is_told_and_leaves_no_trace_in_the_others() -> None:
    grey = exposed(under_lights(30), AREA)
    covered = grey.copy()
    bars = {3: np.s_[40:52, 10:85], 7: np.s_[40:52, 12:80], 11: np.s_[20:90, 60:80]}
    for number, place in bars.items():
        covered[(number, *place)] = 15
    found = appearance(covered, plain(30), AREA)
    for number, place in bars.items():
        inside = np.zeros(SIZE, np.bool_)
        inside[place] = True
        assert found.weights[number][inside].mean() < 0.15
        away = AREA & (cv2.dilate(inside.astype(np.uint8), np.ones((15, 15))) == 0)
        assert found.weights[number][away].mean() > 0.8
        assert np.abs(found.projected - grey)[number][inside].mean() < 6, "grey levels beneath the bar"


def wobble(seed: int, length: float) -> np.ndarray:
    random = np.random.default_rng(seed)
    flow = np.stack([cv2.GaussianBlur(random.normal(size=SIZE), (0, 0), 10) for _ in range(2)], -1)
    return (flow * length / np.linalg.norm(flow, axis=-1).max()).astype(np.float32)


def test_photographs_that_wobble_are_laid_on_their_common_face() -> None:
    still = exposed(under_lights(24), AREA)
    moved = np.array([shifted(one, wobble(k, 0.02 * SIZE[1]), cv2.INTER_CUBIC) for k, one in enumerate(still)])
    before = appearance(moved, plain(24), AREA)
    offsets, after = align_densely(before, plain(24), AREA)
    inner = np.s_[:, 12:-12, 12:-12]
    apart = [float(np.abs(one.exposed - one.projected)[inner].mean()) for one in (before, after)]
    assert apart[1] < 0.6 * apart[0]
    assert np.linalg.norm(offsets, axis=-1).max() <= MAX_SHIFT * SIZE[1] + 1e-4


def test_where_nothing_moves_nothing_is_moved() -> None:
    grey = exposed(under_lights(24), AREA)
    seen = Appearance(grey, grey, plain(24))
    offsets, _ = align_densely(seen, plain(24), AREA)
    assert np.linalg.norm(offsets[:, 8:-8, 8:-8], axis=-1).mean() < 0.05
