"""The shadow in the picture: one of a known light is found, and tells where the light is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.character_figures.steps import Woken, wake
from engine.character.film.background import fill_background
from engine.character.film.cast_shadow import find_cast_shadow, ground_shadow
from engine.character.rig.measures import picture_camera, pose
from engine.character.sample import sample_picture
from engine.media.image import write_image
from engine.render.lighting.ground_shadow import GroundShadow, cast_on_ground

GROUND = (140, 130, 118)


@pytest.fixture(scope="module")
def woken(tmp_path_factory: pytest.TempPathFactory) -> Woken:
    path = tmp_path_factory.mktemp("shadow") / "photo.png"
    write_image(path, sample_picture())
    return wake(path, {})


def in_the_sun(woken: Woken, light: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """The person on plain ground, and where the shadow is."""
    rgb, alpha = woken.figure.rgb, woken.silhouette.alpha
    plain = np.full_like(rgb, 150)
    plain[len(rgb) // 2 :] = GROUND
    ground = plain.copy()
    camera = picture_camera(woken.character, woken.fitted, (rgb.shape[0], rgb.shape[1]))
    x, y, z = (np.array(light) / np.linalg.norm(light)).tolist()
    sun = GroundShadow(strength=0.5, softness=0.01, reach=float("inf"), light=(x, y, z))
    posed = pose(woken.character, woken.character.pictured)
    cast_on_ground(ground, plain, posed, woken.character.mesh.triangles, camera, sun)
    shown = (alpha[..., None] * rgb + (1 - alpha[..., None]) * ground).astype(np.uint8)
    return shown, (ground.sum(-1, dtype=int) < 0.8 * plain.sum(-1, dtype=int)) & (alpha < 0.5)


@pytest.mark.parametrize("light", [(0.6, 1, 0.2), (-0.8, 1, 0.35)])
def test_a_shadow_is_found_and_tells_of_the_light(woken: Woken, light: tuple[float, float, float]) -> None:
    rgb, truth = in_the_sun(woken, light)
    shadow = find_cast_shadow(rgb, woken.silhouette.alpha)
    found = shadow.mask > 0.5
    assert (found & truth).sum() / (found | truth).sum() > 0.7
    x, y, z = ground_shadow(shadow, woken.character, woken.fitted).light
    assert y > 0
    angle = np.degrees(np.arctan2(z, x) - np.arctan2(light[2], light[0]))
    assert abs(angle) < 15


def test_the_shadow_goes_with_the_person_who_casts_it(woken: Woken) -> None:
    """Where both were, the background is the ground and the wall that are known."""
    rgb, truth = in_the_sun(woken, (0.6, 1, 0.2))
    assert np.abs(rgb[truth].astype(int) - GROUND).max() > 40
    filled = fill_background(replace(woken.figure, rgb=rgb), (woken.silhouette,))
    assert filled.shadow.strength > 0
    assert np.abs(filled.rgb[truth].astype(int) - GROUND).mean() < 6
    above = woken.silhouette.alpha[: len(rgb) // 2 - 20] > 0.5
    assert np.abs(filled.rgb[: len(above)][above].astype(int) - 150).max() < 12


def test_without_a_shadow_none_is_found(woken: Woken) -> None:
    rgb, alpha = woken.figure.rgb.copy(), woken.silhouette.alpha
    rgb[alpha < 0.02] = GROUND
    noise = np.random.default_rng(1).integers(0, 255, rgb.shape).astype(np.uint8)
    for picture in (rgb, np.where(alpha[..., None] > 0.5, rgb, noise).astype(np.uint8)):
        shadow = find_cast_shadow(picture, alpha)
        assert shadow.strength == 0 and not shadow.mask.any()
        assert ground_shadow(shadow, woken.character, woken.fitted) == GroundShadow()
