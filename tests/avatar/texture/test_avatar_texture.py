"""A template person of known colours, filmed: skin, shirt and eyes come back; the mouth is painted."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.avatar.texture.avatar_texture import AvatarTexture, avatar_texture
from engine.avatar.texture.template_surface import TemplateSurface, template_surface
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.avatar.texture.views import FrameView
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig, load_template
from engine.geometry.camera import Camera
from engine.imaging.histogram_matching import to_lab
from engine.performances.modelling.eyes import IRIS_RADIUS, PUPIL_RADIUS
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise
from engine.render.textures.texture_bake import texel_raster

SIZE = 1024
SKIN, SHIRT, IRIS, WHITE = (205, 160, 140), (60, 90, 150), (90, 120, 160), (200, 195, 190)


@pytest.fixture(scope="module")
def surface() -> TemplateSurface:
    return template_surface(load_template(), load_rig(HUMAN_RIG))


def eye_offsets(surface: TemplateSurface, places: NDArray) -> NDArray:
    """(..., ) metres from the axis of the nearer eye."""
    middle = surface.rest[surface.triangles[surface.of("left_eye")]].mean((0, 1))
    return np.hypot(np.abs(places[..., 0]) - middle[0], places[..., 1] - middle[1])


def picture(surface: TemplateSurface, camera: Camera) -> NDArray[np.uint8]:
    raster = rasterise(camera.project(surface.rest), surface.triangles, camera.size, perspective=True)
    places = interpolate(surface.rest, surface.triangles, raster)
    out = np.full((*camera.size, 3), 128, np.uint8)
    out[raster.triangle >= 0] = SKIN
    out[(raster.triangle >= 0) & (places[..., 1] < 0.5)] = SHIRT
    eye = (raster.triangle >= 0) & surface.of("left_eye", "right_eye")[raster.triangle]
    off = eye_offsets(surface, places)
    out[eye] = WHITE
    out[eye & (off < IRIS_RADIUS)] = IRIS
    out[eye & (off < PUPIL_RADIUS)] = 10
    return out


@pytest.fixture(scope="module")
def found(surface: TemplateSurface) -> AvatarTexture:
    lens = Camera((0, 0, 1), 600, (159.5, 219.5), (440, 320))
    body = [lens.aimed([2.6 * np.sin(a), 0.3, 2.6 * np.cos(a)], [0, 0, 0]) for a in np.arange(4) * np.pi / 2]
    head = [lens.aimed([0.6 * np.sin(a), 0.75, 0.6 * np.cos(a)], [0, 0.72, 0]) for a in (-0.4, 0.0, 0.4)]
    views = [FrameView(each, lambda each=each: picture(surface, each)) for each in (*body, *head)]
    return avatar_texture(surface, load_rig(HUMAN_RIG), surface.rest, views, SIZE)


def lab(colours: NDArray) -> NDArray:
    return np.asarray(to_lab(np.asarray(colours, np.float32).reshape(-1, 3)))


def test_skin_and_shirt_come_back(surface: TemplateSurface, found: AvatarTexture) -> None:
    raster = texel_raster(surface.atlas, SIZE)
    skin = surface.fitted(surface.rest).stitched
    for side in surface.hands.values():
        skin &= ~side
    texels = PartTexels.of(raster, skin)
    height = texels.blend(surface.rest, surface.triangles)[:, 1]
    colours = found.texture.reshape(-1, 3)[texels.texels]
    for where, colour in (((height > 0.56), SKIN), ((height < 0.44), SHIRT)):
        away = np.linalg.norm(lab(colours[where]) - lab(np.array(colour)), axis=1)
        assert np.quantile(away, 0.95) < 4


def test_eyes_have_the_colours_of_the_frames(surface: TemplateSurface, found: AvatarTexture) -> None:
    assert found.eyes_seen
    texels = PartTexels.of(texel_raster(surface.atlas, SIZE), surface.of("left_eye"))
    places = texels.blend(surface.rest, surface.triangles)
    off = np.where(places[:, 2] > 0.13, eye_offsets(surface, places), 1)
    colours = found.texture.reshape(-1, 3)[texels.texels]
    iris = colours[(off > 1.4 * PUPIL_RADIUS) & (off < 0.7 * IRIS_RADIUS)].mean(0)
    assert np.linalg.norm(lab(iris) - lab(np.array(IRIS))) < 6  # lashes shade it
    white = colours[(off > 1.4 * IRIS_RADIUS)].mean(0)
    assert np.linalg.norm(lab(white) - lab(np.array(WHITE))) < 5
    assert colours[off < 0.5 * PUPIL_RADIUS].mean() < 60


def test_most_of_the_skin_is_seen_and_nothing_is_left_empty(found: AvatarTexture) -> None:
    assert 0.6 < found.seen_share < 1
    assert (found.texture.max(2) > 5).all()
