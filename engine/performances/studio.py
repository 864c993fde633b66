"""The studio: camera, lamps, backdrop, and the way from a scene to a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.performances import chart
from engine.performances.actor import Actor, Part, Scene
from engine.performances.eyes import colour_of_eye
from engine.render.attributes import interpolate, sample_texture
from engine.render.camera import Camera
from engine.render.film import develop, shrink
from engine.render.light import Lamps, dome, softbox
from engine.render.rasteriser import Raster, rasterise
from engine.render.shading import Surface, illuminate
from engine.render.strands import draw_strands, shade_strands
from engine.render.subsurface import diffuse
from engine.render.surface import bump, chart_tangents

SIZE = 512
SAMPLES = 2
"""Pixels are rendered as SAMPLES x SAMPLES and averaged."""

CAMERA = Camera(eye=(0.0, 0.775, 1.62), focal=SIZE * 1.50 / 0.312, centre=(255.5, 252.0), size=(SIZE, SIZE))
"""A portrait lens 1.6 m away: little perspective, the face about 250 pixels wide."""

EXPOSURE = 1.55


def lamps(detail: float = 1.0) -> Lamps:
    """A large warm key from the sitter's right, a weak fill, two rims, a dim room; `detail` scales how many lamps
    stand for each."""

    def number(count: int) -> int:
        return max(round(count * detail), 2)

    return (
        softbox(-40, 34, (44, 52), (2.05, 1.98, 1.86), number(26))
        + softbox(50, 8, (70, 60), (0.42, 0.44, 0.47), number(10))
        + softbox(152, 42, (50, 40), (0.75, 0.75, 0.77), number(4))
        + softbox(-152, 42, (50, 40), (0.45, 0.45, 0.45), number(4))
        + dome((0.14, 0.145, 0.155), (0.085, 0.085, 0.085), (0.05, 0.043, 0.037), number(30))
    )


HAIR_LAMPS = 0.3
"""Detail of the lamps for hair: it is too rough to show more."""

HAIR = np.array([0.052, 0.031, 0.019], np.float32)


@dataclass(frozen=True)
class Seen:
    """The visible points of a picture, row by row, and where they lie: `covered` (H, W) marks their pixels."""

    covered: NDArray[np.bool_]
    raster: Raster
    part: NDArray[np.uint8]
    position: NDArray[np.float32]
    normal: NDArray[np.float32]
    view: NDArray[np.float32]
    motion: None = None


@dataclass(frozen=True)
class Matter:
    """What the visible points are made of: `albedo` (N, 3), `bumped` normals (N, 3), `coarse` normals (N, 3) that
    the diffuse light follows, `roughness` (N,), `reflectance` (N,), `softness` (N, 3), `translucency` (N,)."""

    albedo: NDArray[np.float32]
    coarse: NDArray[np.float32]
    bumped: NDArray[np.float32]
    roughness: NDArray[np.float32]
    reflectance: NDArray[np.float32]
    softness: NDArray[np.float32]
    translucency: NDArray[np.float32]


def photograph(actor: Actor, scene: Scene, wrinkles: NDArray[np.float32] | None = None) -> NDArray[np.uint8]:
    """A picture (SIZE, SIZE, 3) uint8 of a scene."""
    camera = CAMERA.enlarged(SAMPLES)
    seen = look(scene, camera)
    matter = materials(actor, scene, seen, wrinkles)
    surface = Surface(
        seen.position, matter.coarse, matter.bumped, seen.view, matter.roughness, matter.reflectance, matter.softness
    )
    centre = np.array([0.0, 0.745, 0.05], np.float32)
    lighting = illuminate(surface, lamps(), scene.casters, centre, 0.27)
    irradiance = _spread(lighting.irradiance, seen.covered)
    translucency = _spread(matter.translucency, seen.covered)
    scale = camera.focal / (camera.eye[2] - 0.12)
    wandered = diffuse(irradiance, translucency, seen.raster.depth, scale)[seen.covered]
    picture = backdrop(camera.size)
    picture[seen.covered] = matter.albedo / np.pi * wandered + lighting.mirrored
    _hair(actor, scene, camera, picture, seen.raster.depth, irradiance)
    return develop(shrink(picture, SAMPLES), EXPOSURE)


def look(scene: Scene, camera: Camera) -> Seen:
    """Which points of the scene the camera sees."""
    raster = rasterise(camera.project(scene.vertices), scene.triangles, camera.size, perspective=True)
    covered = raster.triangle >= 0
    position = interpolate(scene.vertices, scene.triangles, raster)[covered]
    normal = unit(interpolate(scene.normals, scene.triangles, raster)[covered])
    view = unit(np.asarray(camera.eye, np.float32) - position)
    return Seen(covered, raster, scene.part[raster.triangle[covered]], position, normal, view)


def _hair(
    actor: Actor,
    scene: Scene,
    camera: Camera,
    picture: NDArray[np.float32],
    depth: NDArray[np.float32],
    irradiance: NDArray[np.float32],
) -> None:
    """Draw the crop, lit through the hair itself, then brows and lashes, lit as the skin around them."""
    few = lamps(HAIR_LAMPS)
    crop = scene.hairs[0]
    _strands(actor.crop.widths, crop, actor.crop.tone, actor.passed, few, camera, picture, depth)
    for rooted, hairs in zip(actor.rooted, scene.hairs[1:], strict=True):
        pixels = camera.project(hairs[:, 0])
        x = np.clip(np.rint(pixels[:, 0]).astype(int), 0, camera.size[1] - 1)
        y = np.clip(np.rint(pixels[:, 1]).astype(int), 0, camera.size[0] - 1)
        near = irradiance[y, x].mean(1) / lamps().irradiance.sum(0).mean()
        passed = np.broadcast_to(np.clip(1.6 * near, 0.05, 1)[:, None, None], (*hairs.shape[:2], len(few.directions)))
        _strands(rooted.widths, hairs, np.full(len(hairs), 0.62), passed, few, camera, picture, depth)


def _strands(
    widths: NDArray[np.float32],
    hairs: NDArray[np.float32],
    tone: NDArray[np.floating],
    passed: NDArray[np.floating],
    few: Lamps,
    camera: Camera,
    picture: NDArray[np.float32],
    depth: NDArray[np.float32],
) -> None:
    count, pieces = hairs.shape[:2]
    tangents = unit(np.gradient(hairs, axis=1).reshape(-1, 3))
    view = unit(np.asarray(camera.eye, np.float32) - hairs.reshape(-1, 3))
    colour = np.repeat(tone.astype(np.float32), pieces)[:, None] * HAIR
    radiance = shade_strands(tangents, view, passed.reshape(count * pieces, -1), few, colour, 1.0)
    pixels = camera.project(hairs.reshape(-1, 3)).reshape(count, pieces, 3)
    draw_strands(picture, depth, pixels, radiance.reshape(hairs.shape), widths * camera.focal / pixels[..., 2])


def backdrop(size: tuple[int, int]) -> NDArray[np.float32]:
    """A grey paper roll, lit brighter behind the sitter."""
    y, x = np.mgrid[: size[0], : size[1]].astype(np.float32) / size[0]
    glow = np.exp(-(((x - 0.56) / 0.62) ** 2 + ((y - 0.42) / 0.70) ** 2))
    return (0.085 + 0.155 * glow)[..., None] * np.array([0.95, 1.0, 1.03], np.float32)


def materials(actor: Actor, scene: Scene, seen: Seen, wrinkles: NDArray[np.float32] | None) -> Matter:
    """The material of every visible point."""
    n = len(seen.part)
    matter = Matter(
        albedo=np.zeros((n, 3), np.float32),
        coarse=seen.normal.copy(),
        bumped=seen.normal.copy(),
        roughness=np.full(n, 0.5, np.float32),
        reflectance=np.full(n, 0.028, np.float32),
        softness=np.zeros((n, 3), np.float32),
        translucency=np.zeros(n, np.float32),
    )
    _skin(actor, scene, seen, matter, wrinkles)
    for side, part in enumerate((Part.LEFT_EYE, Part.RIGHT_EYE)):
        _eye(actor, scene, seen, matter, side, part)
    _mouth(actor, scene, seen, matter)
    _cloth(actor, scene, seen, matter)
    return matter


def _skin(actor: Actor, scene: Scene, seen: Seen, matter: Matter, wrinkles: NDArray[np.float32] | None) -> None:
    of_skin = seen.part == Part.SKIN
    count = len(actor.chart)
    triangles = scene.triangles[scene.part == Part.SKIN]
    whole = np.ptp(actor.chart[triangles, 0], axis=1) < 0.1
    tangents = chart_tangents(scene.vertices[:count], actor.chart, triangles[whole])
    by_vertex = np.zeros((len(scene.vertices), 11), np.float32)
    masks = np.stack([actor.inner, actor.margin, actor.scalp], 1)
    by_vertex[:count] = np.concatenate([actor.chart, tangents, masks], 1)
    at = interpolate(by_vertex, scene.triangles, seen.raster)
    place = chart.texture_coordinates(at[..., :2])
    height = actor.skin.height if wrinkles is None else actor.skin.height + wrinkles
    slope_v, slope_u = np.gradient(height, 1 / chart.TEXELS)
    maps = np.concatenate(
        [actor.skin.albedo, actor.skin.roughness[..., None], slope_u[..., None], -slope_v[..., None], actor.skin.lips[..., None]], 2
    )
    on_skin = np.zeros(seen.covered.shape, bool)
    on_skin[seen.covered] = of_skin
    found = sample_texture(maps, place, on_skin)[on_skin]
    values = at[on_skin]
    inner, margin = values[:, 8:9], values[:, 9:10]
    mucosa = np.array([0.36, 0.13, 0.11], np.float32)
    rim = np.array([0.55, 0.30, 0.25], np.float32)
    albedo = found[:, :3] + margin * 0.6 * (rim - found[:, :3])
    albedo = albedo * (1 - 0.8 * values[:, 10:11])
    matter.albedo[of_skin] = albedo + inner * (mucosa - albedo)
    rough = found[:, 3] + margin[:, 0] * (0.30 - found[:, 3])
    matter.roughness[of_skin] = rough + inner[:, 0] * (0.33 - rough)
    matter.bumped[of_skin] = bump(matter.coarse[of_skin], values[:, 2:8], found[:, 4:6] * (1 - inner))
    matter.softness[of_skin] = [0.55, 0.30, 0.15]
    matter.translucency[of_skin] = 1


def _eye(actor: Actor, scene: Scene, seen: Seen, matter: Matter, side: int, part: Part) -> None:
    chosen = seen.part == part
    motion = scene.posed.eyes[side]
    turn, centre = motion[:3, :3], motion[:3, :3] @ actor.figure.eyes[side].centre + motion[:3, 3]
    points, view = (seen.position[chosen] - centre) @ turn, seen.view[chosen] @ turn
    albedo, cornea = colour_of_eye(points, view)
    matter.albedo[chosen] = albedo
    ahead = (turn @ [0.0, 0.0, 1.0]).astype(np.float32)
    matter.coarse[chosen] = unit(seen.normal[chosen] + cornea[:, None] * 0.8 * (ahead - seen.normal[chosen]))
    matter.roughness[chosen] = 0.22 - 0.10 * cornea
    matter.reflectance[chosen] = 0.025
    matter.softness[chosen] = 1
    matter.translucency[chosen] = 0.3 * (1 - cornea)


def _mouth(actor: Actor, scene: Scene, seen: Seen, matter: Matter) -> None:
    teeth, tongue = seen.part == Part.TEETH, seen.part == Part.TONGUE
    first = int((scene.triangles[scene.part == Part.TEETH]).min())
    by_vertex = np.zeros((len(scene.vertices), 2), np.float32)
    enamel = np.concatenate([actor.upper.enamel, actor.lower.enamel])
    shade = np.concatenate([actor.upper.shade, actor.lower.shade])
    by_vertex[first : first + len(enamel)] = np.stack([enamel, shade], 1)
    at = interpolate(by_vertex, scene.triangles, seen.raster)[seen.covered][teeth]
    level = np.clip(at[:, :1], 0, 1)
    tooth = np.array([0.66, 0.57, 0.43], np.float32) + level**0.7 * np.array([0.05, 0.09, 0.12], np.float32)
    tooth = tooth * (1 - 0.16 * np.clip((level - 0.82) / 0.18, 0, 1)) * at[:, 1:]
    gum = np.array([0.47, 0.20, 0.18], np.float32)
    is_gum = at[:, :1] < -0.02
    matter.albedo[teeth] = np.where(is_gum, gum, tooth)
    matter.roughness[teeth] = np.where(is_gum[:, 0], 0.35, 0.24)
    matter.reflectance[teeth] = 0.035
    matter.softness[teeth] = 0.3
    matter.translucency[teeth] = 0.5
    matter.albedo[tongue] = [0.44, 0.19, 0.17]
    matter.roughness[tongue] = 0.38
    matter.softness[tongue] = 0.3
    matter.translucency[tongue] = 1


def _cloth(actor: Actor, scene: Scene, seen: Seen, matter: Matter) -> None:
    chosen = seen.part == Part.CLOTH
    by_vertex = np.zeros((len(scene.vertices), 2), np.float32)
    by_vertex[-len(actor.shirt.weave) :] = actor.shirt.weave
    on_cloth = np.zeros(seen.covered.shape, bool)
    on_cloth[seen.covered] = chosen
    weave = interpolate(by_vertex, scene.triangles, seen.raster)[on_cloth]
    around, away = weave[:, 0], weave[:, 1]
    rib = np.where(away < 0.017, 0.5 + 0.5 * np.cos(2 * np.pi * around / 0.0021), 0.75)
    fleck = np.sin(around * 5200 + 3.1 * np.sin(away * 900)) * np.sin(away * 6100 + 2.3 * np.sin(around * 1100))
    stitch = 1 - 0.35 * np.exp(-0.5 * ((away - 0.0178) / 0.0006) ** 2)
    shade = (0.72 + 0.28 * rib) * (1 + 0.10 * fleck) * stitch
    matter.albedo[chosen] = shade[:, None] * np.array([0.050, 0.060, 0.078], np.float32)
    matter.roughness[chosen] = 0.75
    matter.reflectance[chosen] = 0.02


def unit(vectors: NDArray[np.floating]) -> NDArray[np.float32]:
    """Vectors (N, 3) scaled to length one."""
    return (vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-9)).astype(np.float32)


def _spread(values: NDArray[np.float32], covered: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Values of the covered pixels as a picture, zero elsewhere."""
    picture = np.zeros((*covered.shape, *values.shape[1:]), np.float32)
    picture[covered] = values
    return picture
