"""The actor: body, skin, eyes and teeth put together, and set into a pose as one scene of meshes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from engine.body.subdivision import Subdivision, catmull_clark
from engine.body.template import vertex_mask
from engine.geometry.mesh.surface import triangulate, vertex_normals
from engine.performances.modelling import chart
from engine.performances.modelling.brows import RootedHairs, grow_brows, grow_lashes, place_hairs
from engine.performances.modelling.eyes import Eyeball, build_eyeball
from engine.performances.modelling.figure import Figure, Pose, PosedFigure, build_figure, pose_figure
from engine.performances.modelling.hair import Haircut, grow_crop, hair_cover
from engine.performances.modelling.hair_transmittance import light_through
from engine.performances.modelling.shirt import Shirt, drape, sew_shirt
from engine.performances.modelling.skin import Skin, paint_skin
from engine.performances.modelling.teeth import Arch, Dentition, build_dentition
from engine.performances.modelling.wrinkles import Wrinkles, carve, wrinkle_relief
from engine.render.lighting.light import Lamps


class Part(IntEnum):
    """What a triangle of the scene belongs to."""

    SKIN = 0
    LEFT_EYE = 1
    RIGHT_EYE = 2
    TEETH = 3
    TONGUE = 4
    CLOTH = 5


Piece = tuple[NDArray, NDArray, Part]
"""Vertices, triangles, and what they belong to."""

UPPER_ARCH = Arch(gum=0.7304, front=0.1442, up=-1)
LOWER_ARCH = Arch(gum=0.7122, front=0.1415, up=1)
"""Placed by eye: the upper incisors just show when the lips part, the lower ones stand behind them."""


@dataclass(frozen=True)
class Actor:
    """All that stays the same from frame to frame; N vertices of the fine skin.

    figure : the body, its eyes and lids.
    skin : the maps of its colour and relief.
    wrinkles : what its face units fold.
    eyeball, upper, lower : an eye and both rows of teeth.
    casting : the same with fewer triangles, for shadows.
    chart : (N, 2) float32, place on the map of the head.
    inner : (N,) float32 in [0, 1], inside of the mouth.
    margin : (N,) float32 in [0, 1], moist rims of the lids.
    scalp : (N,) float32 in [0, 1], under the hair.
    veiled : (N,) float32 in [0, 1], there and just outside its border, where single hairs keep the skin from shining.
    tongue : its surface.
    shirt : bound to the skin.
    crop : the hair of the head.
    passed : (S, K, L) float32 in [0, 1], the share of each of the hair's L lamps that reaches each point of `crop`.
    rooted : brows and lashes, which follow the skin.
    """

    figure: Figure
    skin: Skin
    wrinkles: Wrinkles
    eyeball: Eyeball
    upper: Dentition
    lower: Dentition
    casting: tuple[Eyeball, Dentition, Dentition]
    chart: NDArray[np.float32]
    inner: NDArray[np.float32]
    margin: NDArray[np.float32]
    scalp: NDArray[np.float32]
    veiled: NDArray[np.float32]
    tongue: Subdivision
    shirt: Shirt
    crop: Haircut
    passed: NDArray[np.float32]
    rooted: tuple[RootedHairs, ...]


@dataclass(frozen=True)
class Scene:
    """The actor in a pose.

    vertices : (V, 3) float32 metres, those of the fine skin first.
    normals : (V, 3) float32 unit vectors.
    triangles : (T, 3) int32.
    part : (T,) uint8, a `Part` for each triangle.
    casters : vertices and triangles of a lighter mesh of the same, for shadows.
    hairs : points (S, K, 3) float32 metres of the crop, then of each of the actor's `rooted` hairs.
    wrinkles : (h, w) float32 metres, relief over the map of the head.
    posed : the figure in this pose.
    """

    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    triangles: NDArray[np.int32]
    part: NDArray[np.uint8]
    casters: tuple[NDArray[np.float32], NDArray[np.int32]]
    hairs: tuple[NDArray[np.float32], ...]
    wrinkles: NDArray[np.float32]
    posed: PosedFigure


def build_actor(lamps: Lamps) -> Actor:
    """Make the actor, half a minute; `lamps` are those that light the hair (see `Actor.passed`)."""
    figure = build_figure()
    rest = (figure.fine @ figure.rest).astype(np.float32)
    inner = np.clip(figure.fine @ vertex_mask(figure.template, "inside-mouth"), 0, 1)
    from_eye = np.min([np.linalg.norm(rest - eye.centre, axis=1) for eye in figure.eyes], axis=0)
    template = figure.template
    once = catmull_clark(template.quads[template.faces("tongue")], len(figure.rest))
    places = chart.coordinates(rest)
    cover, above = hair_cover(places), chart.smooth_step(rest[:, 1], 0.70, 0.72)
    eyeball = build_eyeball()
    crop = grow_crop(figure, places)
    return Actor(
        figure=figure,
        skin=paint_skin(),
        wrinkles=carve(),
        eyeball=eyeball,
        upper=build_dentition(UPPER_ARCH),
        lower=build_dentition(LOWER_ARCH, seed=4),
        casting=(
            build_eyeball(14, 24),
            build_dentition(UPPER_ARCH, detail=0.4),
            build_dentition(LOWER_ARCH, 0.4, seed=4),
        ),
        chart=places,
        inner=inner.astype(np.float32),
        margin=chart.smooth_step(from_eye, 0.0168, 0.0160),
        scalp=chart.smooth_step(cover, -0.001, 0.006) * above,
        veiled=chart.smooth_step(cover, -0.011, -0.002) * above,
        tongue=once,
        shirt=sew_shirt(figure),
        crop=crop,
        passed=light_through(crop.points, crop.normals, crop.widths, lamps),
        rooted=(grow_brows(figure, places), grow_lashes(figure, eyeball)),
    )


def stage(actor: Actor, pose: Pose, lit: bool = True) -> Scene:
    """Set the actor into a pose. A scene that will not be `lit` needs nothing that casts shadows."""
    posed = pose_figure(actor.figure, pose)
    tongue = (actor.tongue.points @ posed.cage).astype(np.float32)
    tongue_part = (tongue, triangulate(actor.tongue.quads), Part.TONGUE)
    rest = [*_rigid_parts(actor, posed, actor.eyeball, actor.upper, actor.lower), tongue_part]
    skin_triangles = triangulate(actor.figure.quads)
    normals = vertex_normals(posed.skin, skin_triangles)
    cloth = drape(actor.shirt, posed.skin, normals)
    fine = _join([(posed.skin, skin_triangles, Part.SKIN), *rest, (cloth, actor.shirt.triangles, Part.CLOTH)])
    crop = _move(posed.head, actor.crop.points.reshape(-1, 3)).reshape(actor.crop.points.shape)
    centres = np.stack([m[:3, :3] @ e.centre + m[:3, 3] for m, e in zip(posed.eyes, actor.figure.eyes, strict=True)])
    rooted = [place_hairs(hairs, posed.skin, normals, centres) for hairs in actor.rooted]
    casters: list[Piece] = (
        []
        if not lit
        else (
            [
                (posed.coarse_skin, triangulate(actor.figure.coarse_quads), Part.SKIN),
                *_rigid_parts(actor, posed, *actor.casting),
                tongue_part,
                (cloth, actor.shirt.light_triangles, Part.CLOTH),
                (*_ribbons(crop), Part.CLOTH),
            ]
        )
    )
    light = _join(casters or [rest[0]])
    return Scene(
        vertices=fine[0],
        normals=vertex_normals(fine[0], fine[1]),
        triangles=fine[1],
        part=fine[2],
        casters=(light[0], light[1]),
        hairs=(crop, *rooted),
        wrinkles=wrinkle_relief(actor.wrinkles, pose.units),
        posed=posed,
    )


def _rigid_parts(actor: Actor, posed: PosedFigure, eyeball: Eyeball, upper: Dentition, lower: Dentition) -> list[Piece]:
    eyes = zip(actor.figure.eyes, posed.eyes, (Part.LEFT_EYE, Part.RIGHT_EYE), strict=True)
    return [
        *((_move(motion, eyeball.vertices + eye.centre), eyeball.triangles, part) for eye, motion, part in eyes),
        (_move(posed.head, upper.vertices), upper.triangles, Part.TEETH),
        (_move(posed.jaw, lower.vertices), lower.triangles, Part.TEETH),
    ]


def _ribbons(hairs: NDArray[np.float32], every: int = 9, width: float = 0.0011) -> tuple[NDArray, NDArray]:
    """Every ninth hair as a ribbon wide enough to cast the shadow of all: vertices and triangles."""
    chosen = hairs[::every, ::3]
    ahead = np.gradient(chosen, axis=1)
    across = np.cross(ahead, [0.3, 0.2, 1.0])
    across *= width / 2 / np.maximum(np.linalg.norm(across, axis=2, keepdims=True), 1e-9)
    vertices = np.stack([chosen - across, chosen + across], 2)
    index = np.arange(vertices.size // 3).reshape(vertices.shape[:3])
    quads = np.stack([index[:, :-1, 0], index[:, :-1, 1], index[:, 1:, 1], index[:, 1:, 0]], 2).reshape(-1, 4)
    return vertices.reshape(-1, 3), triangulate(quads)


def _move(motion: NDArray[np.float64], points: NDArray[np.floating]) -> NDArray[np.float32]:
    return (points @ motion[:3, :3].T + motion[:3, 3]).astype(np.float32)


def _join(
    pieces: list[Piece],
) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.uint8]]:
    counts = np.cumsum([0, *(len(vertices) for vertices, _, _ in pieces)])
    return (
        np.concatenate([vertices for vertices, _, _ in pieces]).astype(np.float32),
        np.concatenate([t + n for (_, t, _), n in zip(pieces, counts, strict=False)]).astype(np.int32),
        np.concatenate([np.full(len(t), part, np.uint8) for _, t, part in pieces]),
    )
