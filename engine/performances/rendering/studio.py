"""The studio: camera, backdrop, and the way from a scene to a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.performances.modelling.actor import Actor, Scene
from engine.performances.rendering.lighting import catchlights, interreflection, lamps
from engine.performances.rendering.surface_materials import materials
from engine.performances.rendering.visibility import unit, visible_points
from engine.render.lighting.film import box_downsample, develop
from engine.render.lighting.light import Lamps
from engine.render.lighting.shading import Surface, illuminate
from engine.render.lighting.strands import draw_strands, shade_strands
from engine.render.lighting.subsurface import diffuse
from engine.render.rasterisation.rasteriser import Raster

FRAME_SIDE_PIXELS = 512
SAMPLES_PER_PIXEL_SIDE = 2
"""Pixels are rendered as SAMPLES x SAMPLES and averaged."""

STUDIO_CAMERA = Camera(
    eye=(0.0, 0.775, 1.62),
    focal=FRAME_SIDE_PIXELS * 1.50 / 0.294,
    centre=(255.5, 257.0),
    size=(FRAME_SIDE_PIXELS, FRAME_SIDE_PIXELS),
)
"""A portrait lens 1.6 m away: little perspective, the face about 250 pixels wide."""

STUDIO_EXPOSURE = 1.55


HAIR_LAMPS = 0.3
"""Detail of the lamps for hair: it is too rough to show more."""

HAIR_COLOUR = np.array([0.046, 0.027, 0.0165], np.float32)


@dataclass(frozen=True)
class Exposure:
    """A scene as light, before the hair is drawn, supersampled.

    raster, parts : (H, W), int8 and -1 where nothing is, say what the camera sees of the `scene`.
    radiance : (H, W, 3) linear.
    hair : (S, K, 3) the radiance of its hairs.
    """

    scene: Scene
    raster: Raster
    parts: NDArray[np.int8]
    radiance: NDArray[np.float32]
    hair: tuple[NDArray[np.float32], ...]


def photograph(
    actor: Actor, scene: Scene, samples: int = SAMPLES_PER_PIXEL_SIDE, detail: float = 1.0
) -> NDArray[np.uint8]:
    """A picture (SIZE, SIZE, 3) uint8 of a scene: some seconds. For a quick proof take one sample a pixel and less
    `detail` of the lamps."""
    return finish(expose(actor, scene, samples, detail), actor, samples)


def expose(actor: Actor, scene: Scene, samples: int = SAMPLES_PER_PIXEL_SIDE, detail: float = 1.0) -> Exposure:
    """Light a scene."""
    camera = STUDIO_CAMERA.scaled(samples)
    seen = visible_points(scene, camera)
    matter = materials(actor, scene, seen)
    surface = Surface(
        seen.position, matter.coarse, matter.bumped, seen.view, matter.roughness, matter.reflectance, matter.softness
    )
    centre = np.array([0.0, 0.745, 0.05], np.float32)
    lighting = illuminate(surface, lamps(detail), scene.casters, centre, 0.27)
    mirrored = lighting.mirrored + catchlights(seen, lighting.irradiance)
    irradiance = _spread(lighting.irradiance + interreflection(scene, seen, matter.wet), seen.covered)
    translucency = _spread(matter.translucency, seen.covered)
    scale = camera.focal / (camera.eye[2] - 0.12)
    wandered = diffuse(irradiance, translucency, seen.raster.depth, scale)[seen.covered]
    picture = backdrop(camera.size)
    picture[seen.covered] = matter.albedo / np.pi * wandered + mirrored
    light = irradiance.mean(2)
    return Exposure(
        scene, seen.raster, parts_seen(scene, seen.raster), picture, shine_of_hair(actor, scene, light, camera)
    )


def finish(exposure: Exposure, actor: Actor, samples: int = SAMPLES_PER_PIXEL_SIDE) -> NDArray[np.uint8]:
    """Draw the hair over an exposure and develop it: (SIZE, SIZE, 3) uint8."""
    camera = STUDIO_CAMERA.scaled(samples)
    picture = exposure.radiance.copy()
    widths = (actor.crop.widths, *(rooted.widths for rooted in actor.rooted))
    for width, hairs, shine in zip(widths, exposure.scene.hairs, exposure.hair, strict=True):
        pixels = camera.project(hairs.reshape(-1, 3)).reshape(hairs.shape)
        draw_strands(picture, exposure.raster.depth, pixels, shine, width * camera.focal / pixels[..., 2])
    return develop(box_downsample(picture, samples), STUDIO_EXPOSURE)


def parts_seen(scene: Scene, raster: Raster) -> NDArray[np.int8]:
    """What each pixel (H, W) belongs to, -1 where nothing is."""
    return np.where(raster.triangle >= 0, scene.part[raster.triangle].astype(np.int8), np.int8(-1))


def shine_of_hair(
    actor: Actor, scene: Scene, irradiance: NDArray[np.float32], camera: Camera
) -> tuple[NDArray[np.float32], ...]:
    """Radiance (S, K, 3) of all hairs: the crop is lit through the hair itself, brows and lashes as the skin around
    them."""
    few = lamps(HAIR_LAMPS)
    shine = [_shine(scene.hairs[0], actor.crop.tone, actor.passed, few)]
    for hairs, tone in zip(scene.hairs[1:], (0.62, 0.16), strict=True):
        pixels = camera.project(hairs[:, 0])
        x = np.clip(np.rint(pixels[:, 0]).astype(int), 0, camera.size[1] - 1)
        y = np.clip(np.rint(pixels[:, 1]).astype(int), 0, camera.size[0] - 1)
        near = irradiance[y, x] / lamps().irradiance.sum(0).mean()
        passed = np.broadcast_to(np.clip(1.6 * near, 0.05, 1)[:, None, None], (*hairs.shape[:2], len(few.directions)))
        shine.append(_shine(hairs, np.full(len(hairs), tone), passed, few))
    return tuple(shine)


def _shine(
    hairs: NDArray[np.float32], tone: NDArray[np.floating], passed: NDArray[np.floating], few: Lamps
) -> NDArray[np.float32]:
    count, pieces = hairs.shape[:2]
    tangents = unit(np.gradient(hairs, axis=1).reshape(-1, 3))
    view = unit(np.asarray(STUDIO_CAMERA.eye, np.float32) - hairs.reshape(-1, 3))
    colour = np.repeat(tone.astype(np.float32), pieces)[:, None] * HAIR_COLOUR
    return shade_strands(tangents, view, passed.reshape(count * pieces, -1), few, colour, 1.0).reshape(hairs.shape)


def backdrop(size: tuple[int, int]) -> NDArray[np.float32]:
    """A grey paper roll, lit brighter behind the sitter."""
    y, x = np.mgrid[: size[0], : size[1]].astype(np.float32) / size[0]
    glow = np.exp(-(((x - 0.56) / 0.62) ** 2 + ((y - 0.42) / 0.70) ** 2))
    return (0.085 + 0.155 * glow)[..., None] * np.array([0.95, 1.0, 1.03], np.float32)


def _spread(values: NDArray[np.float32], covered: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Values of the covered pixels as a picture, zero elsewhere."""
    picture = np.zeros((*covered.shape, *values.shape[1:]), np.float32)
    picture[covered] = values
    return picture
