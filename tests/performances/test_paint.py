"""Skin, furrows, teeth, hair and shirt: that they lie where a face has them."""

import numpy as np
import pytest

from engine.geometry.mesh.surface import triangulate, vertex_normals
from engine.performances.modelling import chart
from engine.performances.modelling.actor import LOWER_ARCH, UPPER_ARCH
from engine.performances.modelling.figure import Figure, build_figure
from engine.performances.modelling.hair import hair_cover
from engine.performances.modelling.shirt import drape, sew_shirt
from engine.performances.modelling.skin import Skin, paint_skin
from engine.performances.modelling.teeth import build_dentition
from engine.performances.modelling.wrinkles import PRESSED_BY, Wrinkles, carve, wrinkle_relief


@pytest.fixture(scope="module")
def skin() -> Skin:
    return paint_skin()


@pytest.fixture(scope="module")
def wrinkles() -> Wrinkles:
    return carve()


@pytest.fixture(scope="module")
def figure() -> Figure:
    return build_figure()


def at(field: np.ndarray, u: float, v: float) -> np.ndarray:
    row, column = (
        int((chart.CHART_TOP - v) * chart.CHART_TEXELS_PER_METRE),
        int((u - chart.CHART_LEFT) * chart.CHART_TEXELS_PER_METRE),
    )
    return field[row - 8 : row + 9, column - 8 : column + 9].mean((0, 1))


def test_chart_coordinates_are_metres_along_the_cylinder() -> None:
    point = np.array([[0.1 * np.sin(0.3), 0.8, chart.AXIS_DEPTH + 0.1 * np.cos(0.3)]])
    np.testing.assert_allclose(chart.coordinates(point), [[0.03, 0.8]], atol=1e-6)
    corners = np.array([[chart.CHART_LEFT, chart.CHART_TOP], [chart.CHART_RIGHT, chart.CHART_BOTTOM]])
    np.testing.assert_allclose(chart.texture_coordinates(corners), [[0, 0], [1, 1]], atol=1e-6)


def test_noise_has_the_size_it_is_asked_for() -> None:
    rng = np.random.default_rng(0)
    fine, coarse = chart.noise(rng, 0.002), chart.noise(rng, 0.016)
    for field in (fine, coarse):
        assert field.std() == pytest.approx(1, rel=0.01)
    assert np.abs(np.diff(fine, axis=1)).mean() > 5 * np.abs(np.diff(coarse, axis=1)).mean()


def test_skin_is_the_colour_of_skin_and_lips_are_redder(skin: Skin) -> None:
    assert skin.albedo.min() > 0
    assert skin.albedo.max() < 0.9
    cheek, lip = at(skin.albedo, 0.045, 0.76), at(skin.albedo, 0.0, 0.715)
    assert cheek[0] > cheek[1] > cheek[2]
    assert lip[0] / lip[1] > 1.25 * cheek[0] / cheek[1]
    assert at(skin.lips, 0.0, 0.715) > 0.95 and at(skin.lips, 0.0, 0.74) < 0.05


def test_the_same_seed_paints_the_same_skin(skin: Skin) -> None:
    np.testing.assert_array_equal(paint_skin().albedo, skin.albedo)


def test_a_neutral_face_has_hardly_any_furrows(wrinkles: Wrinkles) -> None:
    assert np.abs(wrinkle_relief(wrinkles, {})).max() < 2.2e-4
    assert set(PRESSED_BY) == set(wrinkles.names)


@pytest.mark.parametrize(
    "units, place",
    [
        ({"browInnerUp": 1, "browOuterUpLeft": 1, "browOuterUpRight": 1}, (0.008, 0.8236)),
        ({"mouthSmileLeft": 1}, (0.0272, 0.7405)),
        ({"mouthSmileRight": 1}, (-0.0272, 0.7405)),
        ({"cheekSquintLeft": 1}, (0.0565, 0.7922)),
    ],
    ids=["forehead", "left nasolabial", "right nasolabial", "crow's foot"],
)
def test_units_press_in_their_own_furrows(
    wrinkles: Wrinkles, units: dict[str, float], place: tuple[float, float]
) -> None:
    relief = wrinkle_relief(wrinkles, units) - wrinkle_relief(wrinkles, {})
    row, column = (
        int((chart.CHART_TOP - place[1]) * chart.CHART_TEXELS_PER_METRE),
        int((place[0] - chart.CHART_LEFT) * chart.CHART_TEXELS_PER_METRE),
    )
    assert relief[row - 3 : row + 4, column - 3 : column + 4].min() < -1.5e-4
    assert np.isfinite(relief).all()


def test_left_and_right_furrows_are_mirror_images(wrinkles: Wrinkles) -> None:
    left = wrinkles.relief[wrinkles.names.index("nasolabial_left")]
    right = wrinkles.relief[wrinkles.names.index("nasolabial_right")]
    np.testing.assert_array_equal(left, right[:, ::-1])


@pytest.mark.parametrize("arch", [UPPER_ARCH, LOWER_ARCH], ids=["upper", "lower"])
def test_a_jaw_has_fourteen_teeth_that_point_the_right_way(arch) -> None:  # type: ignore[no-untyped-def]
    teeth = build_dentition(arch)
    crowns = np.unique(teeth.shade[teeth.enamel >= 0])
    assert len(crowns) == 14
    edge, neck = teeth.vertices[teeth.enamel == 1, 1], teeth.vertices[teeth.enamel == 0, 1]
    assert (edge.mean() - neck.mean()) * arch.up > 0.005
    width = np.ptp(teeth.vertices[teeth.enamel >= 0, 0])
    assert 0.045 < width < 0.065


def test_upper_teeth_bite_in_front_of_the_lower_ones() -> None:
    upper, lower = build_dentition(UPPER_ARCH), build_dentition(LOWER_ARCH)
    middle = [np.abs(jaw.vertices[:, 0]) < 0.006 for jaw in (upper, lower)]
    fronts = [jaw.vertices[m & (jaw.enamel > 0.8), 2].max() for jaw, m in zip((upper, lower), middle, strict=True)]
    assert fronts[0] > fronts[1]


def test_coarser_teeth_have_the_same_shape() -> None:
    fine, coarse = build_dentition(UPPER_ARCH), build_dentition(UPPER_ARCH, detail=0.4)
    np.testing.assert_allclose(np.ptp(coarse.vertices, axis=0), np.ptp(fine.vertices, axis=0), atol=8e-4)
    assert len(coarse.triangles) < 0.3 * len(fine.triangles)


def test_hair_grows_on_the_crown_and_not_on_face_or_ears() -> None:
    places = np.array([[0.0, 0.90], [0.0, 0.84], [0.13, 0.83], [0.115, 0.775], [0.25, 0.78], [0.0, 0.76]])
    assert (hair_cover(places) > 0).tolist() == [True, False, True, False, True, False]


def test_the_shirt_lies_outside_the_skin_and_moves_with_it(figure: Figure) -> None:
    shirt = sew_shirt(figure)
    skin = (figure.fine @ figure.rest).astype(np.float32)
    normals = vertex_normals(skin, triangulate(figure.quads))
    cloth = drape(shirt, skin, normals)
    away = shirt.weave[:, 1]
    assert shirt.lift[away > 0.003].min() > 0.0005
    up = np.array([0, 0.01, 0], np.float32)
    np.testing.assert_allclose(drape(shirt, skin + up, normals), cloth + up, atol=1e-6)
    assert cloth[:, 1].max() < 0.69  # below the jaw
