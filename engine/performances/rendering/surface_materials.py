"""What the actor is made of: colour, gloss and relief of every point that the camera sees."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.surface import chart_tangents
from engine.performances.modelling import chart
from engine.performances.modelling.actor import Actor, Part, Scene
from engine.performances.modelling.eyes import colour_of_eye
from engine.performances.modelling.shirt import COLLAR_WIDTH
from engine.performances.rendering.visibility import VisiblePoints, unit
from engine.render.lighting.bump import bump
from engine.render.rasterisation.attributes import interpolate, sample_texture


@dataclass(frozen=True)
class SurfaceMaterials:
    """What the N visible points are made of.

    albedo : (N, 3) float32.
    coarse : (N, 3) float32 unit vectors, the normals that diffuse light follows.
    bumped : (N, 3) float32 unit vectors, the normals with fine relief.
    roughness : (N,) float32, of the first lobe.
    reflectance : (N,) float32, at normal incidence.
    softness : (N, 3) float32 in [0, 1], how far the diffuse light of each colour forgets the fine relief.
    translucency : (N,) float32 in [0, 1], how much of the light wanders under the surface.
    wet : (N,) float32 in [0, 1], rims of the lids.
    """

    albedo: NDArray[np.float32]
    coarse: NDArray[np.float32]
    bumped: NDArray[np.float32]
    roughness: NDArray[np.float32]
    reflectance: NDArray[np.float32]
    softness: NDArray[np.float32]
    translucency: NDArray[np.float32]
    wet: NDArray[np.float32]


def materials(actor: Actor, scene: Scene, seen: VisiblePoints) -> SurfaceMaterials:
    """The material of every visible point."""
    n = len(seen.part)
    matter = SurfaceMaterials(
        albedo=np.zeros((n, 3), np.float32),
        coarse=seen.normal.copy(),
        bumped=seen.normal.copy(),
        roughness=np.full(n, 0.5, np.float32),
        reflectance=np.full(n, 0.028, np.float32),
        softness=np.zeros((n, 3), np.float32),
        translucency=np.zeros(n, np.float32),
        wet=np.zeros(n, np.float32),
    )
    _skin(actor, scene, seen, matter)
    for side, part in enumerate((Part.LEFT_EYE, Part.RIGHT_EYE)):
        _eye(actor, scene, seen, matter, side, part)
    _mouth(actor, scene, seen, matter)
    _cloth(actor, scene, seen, matter)
    return matter


def _skin(actor: Actor, scene: Scene, seen: VisiblePoints, matter: SurfaceMaterials) -> None:
    of_skin = seen.part == Part.SKIN
    count = len(actor.chart)
    triangles = scene.triangles[scene.part == Part.SKIN]
    whole = np.ptp(actor.chart[triangles, 0], axis=1) < 0.1
    tangents = chart_tangents(scene.vertices[:count], actor.chart, triangles[whole])
    by_vertex = np.zeros((len(scene.vertices), 12), np.float32)
    masks = np.stack([actor.inner, actor.margin, actor.scalp, actor.veiled], 1)
    by_vertex[:count] = np.concatenate([actor.chart, tangents, masks], 1)
    at = interpolate(by_vertex, scene.triangles, seen.raster)
    place = chart.texture_coordinates(at[..., :2])
    on_skin = np.zeros(seen.covered.shape, bool)
    on_skin[seen.covered] = of_skin
    found = sample_texture(actor.skin.maps, place, on_skin)[on_skin]
    folds = np.dstack([scene.wrinkles, *chart.slopes(scene.wrinkles)])
    fold = sample_texture(folds, place, on_skin)[on_skin]
    # grooves are darker: less light finds in, and blood shows where the skin is pressed
    groove = np.clip(-fold[:, :1] / 5e-4, 0, 1) * np.array([0.16, 0.26, 0.28], np.float32)
    values = at[on_skin]
    inner, margin = values[:, 8:9], values[:, 9:10]
    mucosa = np.array([0.36, 0.13, 0.11], np.float32)
    rim = np.array([0.46, 0.235, 0.20], np.float32)
    albedo = found[:, :3] * (1 - groove)
    albedo += margin * 0.35 * (rim - albedo)
    albedo = albedo * (1 - 0.8 * values[:, 10:11])
    matter.albedo[of_skin] = albedo + inner * (mucosa - albedo)
    rough = found[:, 3] + margin[:, 0] * (0.38 - found[:, 3])
    matter.roughness[of_skin] = rough + inner[:, 0] * (0.33 - rough)
    # relief finer than a pixel would sparkle where the skin turns away
    facing = chart.smooth_step((seen.normal[of_skin] * seen.view[of_skin]).sum(1), 0.1, 0.55)[:, None]
    matter.bumped[of_skin] = bump(
        matter.coarse[of_skin], values[:, 2:8], (found[:, 4:6] + fold[:, 1:]) * (1 - inner) * facing
    )
    matter.reflectance[of_skin] *= 1 - values[:, 11]
    matter.softness[of_skin] = [0.55, 0.30, 0.15]
    matter.translucency[of_skin] = 1
    matter.wet[of_skin] = margin[:, 0]


def _eye(actor: Actor, scene: Scene, seen: VisiblePoints, matter: SurfaceMaterials, side: int, part: Part) -> None:
    chosen = seen.part == part
    motion = scene.posed.eyes[side]
    turn, centre = motion[:3, :3], motion[:3, :3] @ actor.figure.eyes[side].centre + motion[:3, 3]
    points, view = (seen.position[chosen] - centre) @ turn, seen.view[chosen] @ turn
    albedo, cornea = colour_of_eye(points, view)
    matter.albedo[chosen] = albedo
    ahead = (turn @ [0.0, 0.0, 1.0]).astype(np.float32)
    matter.coarse[chosen] = unit(seen.normal[chosen] + cornea[:, None] * 0.8 * (ahead - seen.normal[chosen]))
    matter.reflectance[chosen] = 0  # an eye mirrors the lamps themselves: see `lighting.catchlights`
    matter.softness[chosen] = 1
    matter.translucency[chosen] = 0.3 * (1 - cornea)


def _mouth(actor: Actor, scene: Scene, seen: VisiblePoints, matter: SurfaceMaterials) -> None:
    teeth, tongue = seen.part == Part.TEETH, seen.part == Part.TONGUE
    first = int((scene.triangles[scene.part == Part.TEETH]).min())
    by_vertex = np.zeros((len(scene.vertices), 2), np.float32)
    enamel = np.concatenate([actor.upper.enamel, actor.lower.enamel])
    shade = np.concatenate([actor.upper.shade, actor.lower.shade])
    by_vertex[first : first + len(enamel)] = np.stack([enamel, shade], 1)
    at = interpolate(by_vertex, scene.triangles, seen.raster)[seen.covered][teeth]
    level = np.clip(at[:, :1], 0, 1)
    tooth = np.array([0.74, 0.64, 0.50], np.float32) + level**0.7 * np.array([0.05, 0.09, 0.13], np.float32)
    tooth = tooth * (1 - 0.16 * np.clip((level - 0.82) / 0.18, 0, 1)) * at[:, 1:]
    gum = np.array([0.47, 0.20, 0.18], np.float32)
    is_gum = at[:, :1] < -0.02
    matter.albedo[teeth] = np.where(is_gum, gum, tooth)
    matter.roughness[teeth] = np.where(is_gum[:, 0], 0.35, 0.24)
    matter.reflectance[teeth] = 0.035
    matter.softness[teeth] = 0.3
    matter.translucency[teeth] = 0.6
    matter.albedo[tongue] = [0.44, 0.19, 0.17]
    matter.roughness[tongue] = 0.38
    matter.softness[tongue] = 0.3
    matter.translucency[tongue] = 1


def _cloth(actor: Actor, scene: Scene, seen: VisiblePoints, matter: SurfaceMaterials) -> None:
    chosen = seen.part == Part.CLOTH
    by_vertex = np.zeros((len(scene.vertices), 2), np.float32)
    by_vertex[-len(actor.shirt.weave) :] = actor.shirt.weave
    on_cloth = np.zeros(seen.covered.shape, bool)
    on_cloth[seen.covered] = chosen
    weave = interpolate(by_vertex, scene.triangles, seen.raster)[on_cloth]
    around, away = weave[:, 0], weave[:, 1]
    rib = np.where(away < COLLAR_WIDTH, 0.5 + 0.5 * np.cos(2 * np.pi * around / 0.0021), 0.75)
    fleck = np.sin(around * 5200 + 3.1 * np.sin(away * 900)) * np.sin(away * 6100 + 2.3 * np.sin(around * 1100))
    stitch = 1 - 0.35 * np.exp(-0.5 * ((away - COLLAR_WIDTH - 0.0008) / 0.0006) ** 2)
    shade = (0.72 + 0.28 * rib) * (1 + 0.10 * fleck) * stitch
    matter.albedo[chosen] = shade[:, None] * np.array([0.050, 0.060, 0.078], np.float32)
    matter.roughness[chosen] = 0.75
    matter.reflectance[chosen] = 0.02
