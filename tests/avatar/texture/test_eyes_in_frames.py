"""Where eyes look in frames, and the shadow of their lids."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from engine.avatar.texture.template_texture.iris_in_frame import iris_centre
from engine.avatar.texture.template_texture.lid_shadow import lash_shadow, lid_shadow
from engine.avatar.texture.views import ChartedSurface
from engine.geometry.texture_charts.texture_atlas import unwrap
from engine.performances.modelling.eyes import IRIS_RADIUS


@pytest.mark.parametrize("centre", [(0.0, 0.0), (0.002, -0.001), (-0.0025, 0.0)])
def test_an_iris_is_found_that_the_upper_lid_cuts(centre: tuple[float, float]) -> None:
    random = np.random.default_rng(4)
    places = random.uniform(-0.0115, 0.0115, (6000, 2))
    places = places[(places[:, 1] < 0.003) & (places[:, 1] > -0.0045)]
    dark = np.hypot(*(places - centre).T) < IRIS_RADIUS
    lightness = np.where(dark, 50, 190) + random.normal(0, 12, len(places))
    assert np.abs(iris_centre(places, lightness) - centre).max() < 0.0008


def test_where_all_is_alike_an_eye_looks_ahead() -> None:
    places = np.random.default_rng(5).uniform(-0.01, 0.01, (3000, 2))
    assert np.allclose(iris_centre(places, np.full(3000, 128.0)), 0)


def sphere(radius: float) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    mesh = trimesh.creation.icosphere(4, radius)
    return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int32)


def test_an_eye_is_darker_beneath_its_upper_lid_and_hardly_where_the_lid_hides_it() -> None:
    ball, faces = sphere(0.012)
    shell, _ = sphere(0.0130)
    middles = shell[faces].mean(1)
    lid = faces[(middles[:, 2] > -0.002) & ((middles[:, 1] > 0.004) | (middles[:, 1] < -0.006))]
    vertices = np.concatenate([ball, shell])
    triangles = np.concatenate([faces, lid + len(ball)]).astype(np.int32)
    atlas, _ = unwrap(vertices, triangles, 128)
    surface = ChartedSurface(vertices, triangles, atlas, np.ones(len(triangles), np.bool_))
    shade = lid_shadow(surface, ball, np.array([0.0, 0.0, 1.0]))
    front = (np.abs(ball[:, 0]) < 0.002) & (ball[:, 2] > 0)
    beneath = front & (ball[:, 1] > 0.0036) & (ball[:, 1] < 0.0039)
    middle = front & (np.abs(ball[:, 1]) < 0.0015)
    hidden = front & (ball[:, 1] > 0.009)
    assert shade[beneath].mean() < 0.92 < 0.99 < shade[middle].mean()
    assert shade[hidden].min() > 0.95
    assert shade.max() <= 1


def test_no_light_comes_from_below() -> None:
    """A tray below an eye takes no light from its front."""
    ball, faces = sphere(0.012)
    turn = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rim = np.stack([0.05 * np.cos(turn), np.full(48, -0.014), 0.05 * np.sin(turn)], 1)
    tray = np.stack([np.full(48, 48), np.arange(48), (np.arange(48) + 1) % 48], 1)
    shades = []
    for vertices, triangles in (
        (ball, faces),
        (np.concatenate([ball, rim, [[0, -0.014, 0]]]), np.concatenate([faces, tray + len(ball)])),
    ):
        atlas, _ = unwrap(vertices, triangles.astype(np.int32), 128)
        surface = ChartedSurface(vertices, triangles.astype(np.int32), atlas, np.ones(len(triangles), np.bool_))
        shades.append(lid_shadow(surface, ball, np.array([0.0, 0.0, 1.0])))
    front = (np.abs(ball[:, 1]) < 0.004) & (ball[:, 2] > 0.008)
    np.testing.assert_allclose(*(shade[front] for shade in shades), atol=0.005)


def test_lashes_darken_what_is_right_beneath_the_upper_lid_alone() -> None:
    ball, _ = sphere(0.012)
    turn = np.linspace(0, 2 * np.pi, 28, endpoint=False)
    across = np.stack([0.009 * np.cos(turn), 0.004 * np.sin(turn)], 1)
    rim = np.column_stack([across, np.sqrt(0.0124**2 - (across**2).sum(1))])
    shade = lash_shadow(ball, rim, np.array([0.0, 0.0, 1.0]))
    middle = (np.abs(ball[:, 0]) < 0.002) & (ball[:, 2] > 0)
    beneath = middle & (ball[:, 1] > 0.0035) & (ball[:, 1] < 0.0039)
    assert 0.5 < shade[beneath].mean() < 0.75
    assert shade[middle & (np.abs(ball[:, 1]) < 0.001)].min() > 0.9
    assert shade[middle & (ball[:, 1] < -0.003)].min() > 0.98
    assert shade[middle & (ball[:, 1] > 0.0105)].min() > 0.98
    assert (shade[ball[:, 2] < -1e-4] == 1).all()
