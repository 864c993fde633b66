"""Light on surfaces whose answer is known in closed form."""

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.render.lighting.light import Lamps, cast_shadow, dome, softbox
from engine.render.lighting.shading import Surface, illuminate
from engine.render.lighting.subsurface import diffuse

NOTHING = (np.zeros((3, 3), np.float32), np.zeros((0, 3), np.int32))


def floor(points: NDArray, reflectance: float = 0.0, roughness: float = 0.5) -> Surface:
    """Points of a level floor seen from straight above."""
    n = len(points)
    up = np.tile(np.array([0, 1, 0], np.float32), (n, 1))
    return Surface(
        position=np.asarray(points, np.float32),
        normal=up,
        bumped=up.copy(),
        view=up.copy(),
        roughness=np.full(n, roughness, np.float32),
        reflectance=np.full(n, reflectance, np.float32),
        softness=np.zeros((n, 3), np.float32),
    )


def lamp(*direction: float) -> Lamps:
    way = np.array(direction, np.float32)[None]
    return Lamps(way / np.linalg.norm(way), np.ones((1, 3), np.float32))


@pytest.mark.parametrize("angle", [0, 30, 60, 85])
def test_irradiance_follows_the_cosine(angle: float) -> None:
    light = lamp(np.sin(np.radians(angle)), np.cos(np.radians(angle)), 0)
    found = illuminate(floor([[0, 0, 0]]), light, NOTHING, np.zeros(3), 1.0)
    np.testing.assert_allclose(found.irradiance, np.cos(np.radians(angle)), atol=1e-5)


def test_a_lamp_below_lights_nothing() -> None:
    found = illuminate(floor([[0, 0, 0]], reflectance=0.5), lamp(0.2, -1, 0), NOTHING, np.zeros(3), 1.0)
    assert not found.irradiance.any()
    assert not found.mirrored.any()


def test_a_board_casts_its_shadow_where_geometry_says() -> None:
    """A board 0.5 m above the floor, 0.4 m wide, under a lamp at 45 degrees: its shadow is displaced by 0.5 m."""
    board = np.array([[-0.2, 0.5, -1], [0.2, 0.5, -1], [0.2, 0.5, 1], [-0.2, 0.5, 1]], np.float32)
    casters = (board, np.array([[0, 1, 2], [0, 2, 3]]))
    x = np.linspace(-1, 1, 81)
    points = np.stack([x, np.zeros(81), np.zeros(81)], 1)
    found = illuminate(floor(points), lamp(-1, 1, 0), casters, np.zeros(3), 1.6).irradiance[:, 0]
    shaded = (x > 0.31) & (x < 0.69)
    free = (x < 0.29) | (x > 0.71)
    np.testing.assert_allclose(found[shaded], 0, atol=1e-6)
    np.testing.assert_allclose(found[free], np.sqrt(0.5), atol=1e-5)


def test_a_surface_does_not_shade_itself() -> None:
    """A sphere lit from the side by its own mesh: every point that faces the lamp is lit in full."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 81), np.linspace(0.01, np.pi - 0.01, 41))
    ball = np.stack([np.sin(v) * np.cos(u), np.cos(v), np.sin(v) * np.sin(u)], -1).reshape(-1, 3).astype(np.float32)
    i = np.arange(len(ball)).reshape(41, 81)
    quads = np.stack([i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]], -1).reshape(-1, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    scaled = ball * np.float32(0.1)
    n = len(ball)
    surface = Surface(scaled, ball, ball, ball, *np.zeros((2, n), np.float32), np.zeros((n, 3), np.float32))
    light = lamp(1, 0.3, 0.2)
    cosine = ball @ light.directions[0]
    found = illuminate(surface, light, (scaled, triangles), np.zeros(3), 0.12).irradiance[:, 0]
    np.testing.assert_allclose(found[cosine > 0.25], cosine[cosine > 0.25], atol=1e-4)
    assert not found[cosine < 0].any()


def test_an_even_dome_gives_pi_times_its_radiance() -> None:
    even = np.ones(3)
    found = illuminate(floor([[0, 0, 0]]), dome(even, even, even, 600), NOTHING, np.zeros(3), 1.0)
    np.testing.assert_allclose(found.irradiance, np.pi, rtol=5e-3)


def test_a_softbox_shares_out_its_light() -> None:
    box = softbox(-40, 30, (40, 50), np.array([3.0, 2.0, 1.0]), 25)
    np.testing.assert_allclose(box.irradiance.sum(0), [3, 2, 1], rtol=1e-5)
    np.testing.assert_allclose(np.linalg.norm(box.directions, axis=1), 1, atol=1e-6)
    middle = box.directions.mean(0)
    assert middle[0] < 0 < middle[1]  # azimuth is positive to +x, elevation up
    assert middle[2] > 0


@pytest.mark.parametrize("roughness", [0.3, 0.6])
def test_the_mirror_lobe_never_gives_more_than_it_gets(roughness: float) -> None:
    even = np.full(3, 1 / np.pi)  # irradiance one
    surface = floor([[0, 0, 0]], reflectance=1.0, roughness=roughness)
    found = illuminate(surface, dome(even, even, even, 1000), NOTHING, np.zeros(3), 1.0)
    # mirrored is radiance per irradiance of lamps: a perfect mirror under this dome would show 1 / pi
    assert 0.5 / np.pi < found.mirrored[0, 0] < 1.02 / np.pi


def test_shadow_maps_measure_along_the_rays() -> None:
    triangle = np.array([[-1, 0.25, -1], [1, 0.25, -1], [0, 0.25, 2]], np.float32)
    shadow = cast_shadow(triangle, np.array([[0, 1, 2]]), np.array([0.0, 1.0, 0.0]), np.zeros(3), 0.5, 64)
    np.testing.assert_allclose(shadow.depth[32, 32], -0.25, atol=1e-6)


def test_even_light_under_the_skin_stays_even() -> None:
    light = np.full((40, 50, 3), 0.7, np.float32)
    ones = np.ones((40, 50), np.float32)
    np.testing.assert_allclose(diffuse(light, ones, ones, 2000.0), light, rtol=1e-5)


def test_red_wanders_further_than_blue_and_none_leaves_the_skin() -> None:
    light = np.zeros((81, 81, 3), np.float32)
    light[40, 40] = 1
    skin = np.ones((81, 81), np.float32)
    skin[:, 60:] = 0
    spread = diffuse(light, skin, np.ones((81, 81), np.float32), 4000.0)
    distance = np.hypot(*np.mgrid[-40:41, -40:41])
    reach = (spread[:, :60] * distance[:, :60, None]).sum((0, 1)) / spread[:, :60].sum((0, 1))
    assert reach[0] > 2 * reach[1] > 2 * reach[2]
    assert not spread[:, 60:].any()


def test_light_does_not_leap_over_a_step_in_depth() -> None:
    light = np.zeros((21, 40, 3), np.float32)
    light[:, :20] = 1
    depth = np.ones((21, 40), np.float32)
    depth[:, 20:] = 1.05
    spread = diffuse(light, np.ones((21, 40), np.float32), depth, 4000.0)
    np.testing.assert_allclose(spread[:, 20:], 0, atol=1e-6)
