"""Baking against surfaces whose colours are known: what views see comes back, what they cannot see does not."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.geometry.texture_charts.texture_atlas import TextureAtlas, atlas_from_uv, unwrap
from engine.render.rasterisation.attributes import interpolate, sample_texture
from engine.render.rasterisation.rasteriser import rasterise
from engine.render.textures.mipmap import build_mipmap
from engine.render.textures.texture_bake import (
    BakedTexture,
    View,
    ViewWeighting,
    bake,
    chart_gap,
    pad_charts,
    texel_raster,
)

SIZE = 256


def colours_of(points: NDArray) -> NDArray:
    """A colour for each place in space, smooth."""
    return 128 + 100 * np.sin(np.asarray(points) * [3.0, 4.0, 5.0] + [0, 1, 2])


def picture(vertices: NDArray, faces: NDArray, camera: Camera, background: float = 0.0) -> NDArray[np.uint8]:
    """The surface in the colours of its places."""
    raster = rasterise(camera.project(vertices), faces, camera.size, perspective=True)
    places = interpolate(vertices, faces, raster)
    shown = np.where((raster.triangle >= 0)[..., None], colours_of(places), background)
    return np.rint(shown).astype(np.uint8)


def ring(count: int, distance: float = 4.0, size: int = 300, height: float = 0.0) -> list[Camera]:
    lens = Camera((0, 0, 1), 1.1 * size, ((size - 1) / 2, (size - 1) / 2), (size, size))
    angles = 2 * np.pi * np.arange(count) / count
    return [lens.aimed([distance * np.sin(a), height, distance * np.cos(a)], [0, 0, 0]) for a in angles]


@pytest.fixture(scope="module")
def ball() -> tuple[NDArray, NDArray, TextureAtlas]:
    mesh = trimesh.creation.icosphere(4)
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    atlas, _ = unwrap(vertices, faces, SIZE)
    return vertices, faces, atlas


def texel_places(vertices: NDArray, faces: NDArray, atlas: TextureAtlas, size: int) -> tuple[NDArray, NDArray]:
    raster = texel_raster(atlas, size)
    return interpolate(vertices, faces, raster), raster.triangle >= 0


def test_many_views_bring_back_the_colours_that_they_were_drawn_with(ball) -> None:
    vertices, faces, atlas = ball
    cameras = [*ring(8), *ring(4, height=3.5), *ring(4, height=-3.5)]
    baked = bake(
        vertices,
        faces,
        atlas,
        (View(picture(vertices, faces, each), each) for each in cameras),
        SIZE,
        ViewWeighting(60),
    )
    places, on = texel_places(vertices, faces, atlas, SIZE)
    seen = baked.weights > 0
    assert not (seen & ~on).any() and seen[on].mean() > 0.97
    away = np.abs(baked.colours - colours_of(places))[seen]
    assert away.mean() < 1.0 and np.quantile(away, 0.99) < 4


def test_one_view_gives_what_it_faces_and_nothing_else(ball) -> None:
    vertices, faces, atlas = ball
    camera = ring(1)[0]
    baked = bake(vertices, faces, atlas, [View(picture(vertices, faces, camera), camera)], SIZE, ViewWeighting(45))
    places, on = texel_places(vertices, faces, atlas, SIZE)
    back = np.array(camera.eye) - places
    cosine = (back / np.linalg.norm(back, axis=2, keepdims=True) * places).sum(2)
    seen = baked.weights > 0
    assert (cosine[seen] > np.cos(np.radians(46))).all()
    assert seen[on & (cosine > np.cos(np.radians(44)))].all()
    np.testing.assert_allclose(baked.weights[seen], cosine[seen], atol=0.02)
    assert (baked.colours[~seen] == 0).all()


def two_walls() -> tuple[NDArray, NDArray, TextureAtlas]:
    """A wall two metres wide at z = 0, and one half a metre wide before its middle, at z = 1; both face +z."""
    square = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    vertices, faces = [], []
    count = 16
    y, x = np.mgrid[: count + 1, : count + 1] / count
    for scale, z in ((1.0, 0.0), (0.25, 1.0)):
        faces.append(quads(count) + len(vertices) * (count + 1) ** 2)
        flat = np.stack([2 * x - 1, 2 * y - 1], 2).reshape(-1, 2) * scale
        vertices.append(np.concatenate([flat, np.full((len(flat), 1), z)], 1))
    uv = np.concatenate([(np.stack([x, y], 2) * 0.45 + [0.02 + 0.5 * k, 0.02]).reshape(-1, 2) for k in (0, 1)])
    corners = np.concatenate(faces)
    assert square.shape == (4, 3)
    return np.concatenate(vertices), corners, atlas_from_uv(uv, corners)


def quads(count: int) -> NDArray:
    a = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    return np.concatenate([np.stack([a, a + 1, a + count + 2], 1), np.stack([a, a + count + 2, a + count + 1], 1)])


def test_what_stands_before_something_is_not_painted_on_it() -> None:
    vertices, faces, atlas = two_walls()
    camera = Camera((0, 0, 4), 300, (149.5, 149.5), (300, 300))
    baked = bake(vertices, faces, atlas, [View(picture(vertices, faces, camera), camera)], SIZE)
    places, on = texel_places(vertices, faces, atlas, SIZE)
    wall = on & (places[..., 2] < 0.5)
    # seen from (0, 0, 4), the small wall hides a third more than itself of the wall behind it
    hidden = wall & (np.abs(places[..., :2]).max(2) < 0.25 * 4 / 3)
    beside = wall & (np.abs(places[..., :2]).max(2) > 0.25 * 4 / 3 + 0.06) & (np.abs(places[..., :2]).max(2) < 0.94)
    assert not baked.weights[hidden].any() and baked.weights[beside].all()
    np.testing.assert_allclose(baked.colours[beside], colours_of(places[beside]), atol=4)
    # and with a camera that is a centimetre off, nothing of the one in front lands on the other either
    off = bake(vertices, faces, atlas, [View(picture(vertices + np.array([0.01, 0, 0]), faces, camera), camera)], SIZE)
    told = wall & (off.weights > 0)
    assert np.abs(off.colours[told] - colours_of(places[told] - [0.01, 0, 0])).max() < 6


def test_pixels_that_are_not_trusted_lend_no_colour() -> None:
    vertices, faces, atlas = two_walls()
    camera = Camera((0, 0, 4), 300, (149.5, 149.5), (300, 300))
    shown = picture(vertices, faces, camera)
    trust = np.ones(camera.size, np.float32)
    trust[:, :150] = 0
    spoiled = shown.copy()
    spoiled[:, :150] = [255, 0, 255]
    clean = bake(vertices, faces, atlas, [View(shown, camera)], SIZE)
    masked = bake(vertices, faces, atlas, [View(spoiled, camera, trust)], SIZE)
    told = masked.weights > 0
    assert 0.3 < told.sum() / (clean.weights > 0).sum() < 0.6
    assert np.abs(masked.colours[told] - clean.colours[told]).max() < 6


def test_views_weigh_by_trust_and_gain_and_paint_only_their_triangles() -> None:
    vertices, faces, atlas = two_walls()
    camera = Camera((0, 0, 4), 300, (149.5, 149.5), (300, 300))
    grey = np.full((300, 300, 3), 100, np.uint8)
    trust = np.full(camera.size, 3.0, np.float32)
    views = [View(grey, camera), View(grey * 2, camera, trust), View(grey, camera, gain=1.5)]
    baked = bake(vertices, faces, atlas, views, SIZE, ViewWeighting(power=0.0))
    told = baked.weights > 0
    np.testing.assert_allclose(baked.weights[told], 5.0)
    np.testing.assert_allclose(baked.colours[told], (100 + 3 * 200 + 150) / 5, atol=1e-3)
    first = np.arange(len(faces)) < len(faces) // 2
    halves = bake(
        vertices, faces, atlas, [View(grey, camera, paints=first), View(grey * 2, camera, paints=~first)], SIZE
    )
    on = halves.weights > 0
    for triangle, value in ((0, 100), (-1, 200)):
        np.testing.assert_allclose(halves.colours[on & (halves.charts == atlas.charts[triangle])], value, atol=1e-3)


def test_what_lies_behind_the_camera_or_beside_the_picture_gives_nothing(ball) -> None:
    vertices, faces, atlas = ball
    inside = Camera((0, 0, 0), 200, (99.5, 99.5), (200, 200))
    shown = np.full((200, 200, 3), 50, np.uint8)
    assert not bake(vertices, faces, atlas, [View(shown, inside)], SIZE).weights.any()
    away = Camera((50, 0, 4), 200, (99.5, 99.5), (200, 200))
    assert not bake(vertices, faces, atlas, [View(shown, away)], SIZE).weights.any()


def test_padded_texels_have_the_colours_of_the_nearest_chart_at_every_size(ball) -> None:
    """Charts of one colour each, as different as can be: whatever size is looked up, on a chart there is its colour alone."""
    vertices, faces, _ = ball
    atlas, _ = unwrap(vertices, faces, SIZE, gap=8)
    raster = texel_raster(atlas, SIZE)
    on = raster.triangle >= 0
    charts = np.where(on, atlas.charts[raster.triangle], -1).astype(np.int32)
    colour = np.random.default_rng(1).integers(0, 256, (charts.max() + 1, 3), np.uint8)
    texture = np.where(on[..., None], colour[charts], np.uint8(0)).astype(np.uint8)
    whole = pad_charts(texture, on, charts)
    gap = chart_gap(charts)
    assert gap >= 7.5
    uv, wanted = atlas.uv[atlas.corners], colour[atlas.charts][:, None].astype(float)  # rims of charts among them
    mipmap = build_mipmap(whole)
    for level in range(2):
        height, width = mipmap.sizes[level]
        start = mipmap.starts[level]
        packed = mipmap.texels[start : start + height * width].reshape(height, width)
        picture = np.stack([packed & 255, packed >> 8 & 255, packed >> 16 & 255], 2).astype(np.uint8)
        assert np.abs(sample_texture(picture, uv) - wanted).max() < 1
    assert np.abs(sample_texture(texture, uv) - wanted).max() > 20, "unpadded, filtering alone spoils the rims"


def test_unknown_texels_of_a_chart_lend_no_colour_to_its_surroundings() -> None:
    charts = np.full((40, 40), -1, np.int32)
    charts[5:15, 5:15], charts[5:15, 25:35] = 0, 1
    known = charts == 0
    known[5:15, 33:35] = True  # of the other chart only what lies far off is known
    texture = np.zeros((40, 40, 3), np.float32)
    texture[5:15, 5:15], texture[5:15, 33:35] = 10, 20
    found = pad_charts(texture, known, charts)
    assert (found[5:15, 15:19] == 10).all() and (found[5:15, 21:25] == 20).all()
    assert (found[5:15, 25:33] == 0).all(), "what is on a chart stays as it is"
    np.testing.assert_array_equal(pad_charts(texture, np.zeros_like(known), charts), texture)


def test_the_gap_between_charts_is_counted_in_texels() -> None:
    charts = np.full((64, 64), -1, np.int32)
    charts[10:20, 10:20] = 0
    assert chart_gap(charts) == np.inf == chart_gap(np.full((8, 8), -1, np.int32))
    charts[10:20, 31:40] = 1
    assert chart_gap(charts) == pytest.approx(11, abs=0.6)
    charts[20:30, 20:30] = 2
    assert chart_gap(charts) <= 1


def test_what_does_not_fit_is_refused(ball) -> None:
    vertices, faces, atlas = ball
    camera = ring(1)[0]
    shown = picture(vertices, faces, camera)
    for view in (
        View(shown[:-1], camera),
        View(shown.astype(np.float32), camera),
        View(shown, camera, np.ones((3, 3), np.float32)),
        View(shown, camera, paints=np.ones(5, np.bool_)),
    ):
        with pytest.raises(ValueError, match="view"):
            bake(vertices, faces, atlas, [view], SIZE)
    with pytest.raises(ValueError, match="other triangles"):
        bake(vertices, faces[:-1], atlas, [], SIZE)


def test_no_view_gives_no_colour(ball) -> None:
    vertices, faces, atlas = ball
    baked = bake(vertices, faces, atlas, [], SIZE)
    assert isinstance(baked, BakedTexture) and not baked.weights.any() and not baked.colours.any()
    assert ((baked.charts >= 0) == (texel_raster(atlas, SIZE).triangle >= 0)).all()
