"""The template's parts unrolled, so that what goes round a limb is a row, and what goes along it a column.

Where a sleeve ends, it ends all round; a stripe goes on behind. So whatever is hidden is looked for in its own row first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.fit.template_fit import load_human
from engine.character.shell.template_mesh import TemplateMesh, template_mesh
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.filling.nearest import nearest_in
from engine.render.rasterisation.rasteriser import Raster, rasterise

ROW_METRES = 0.0025
"""Metres of a row, on the mean body."""
UNROLLED_COLUMNS = 384
"""Columns once round."""
MIN_UNROLLED_PART_WEIGHT = 0.02
"""Share of a part in what moves a vertex, from which on it has a place on the part."""
ARMPIT_DEPTH_METRES = 0.07
"""Metres from the shoulder's joint down to where necklines have ended."""
HIP_BLEND_METRES = 0.03
"""Metres above the crotch at which hips begin to be the trunk's, and over which they come to be it."""
CROWN_RADIUS_METRES = 0.1
"""Metres of a head's radius: above its middle, rows are its latitudes."""


@dataclass(frozen=True)
class UnrolledPart:
    """One part of the template's mean body, unrolled.

    name : one of `engine.body.parts.BODY_PARTS`; a foot has one of its own, as it lies across its leg.
    share : (V,) float32, how much of what moves a vertex is of the part.
    along : (V,) float32, rows from the part's beginning.
    angle : (V,) float32, radians round its axis; 0 in front, or above on arms and feet, and growing to the person's
        left, or forward.
    yoke : of the trunk, the row above which a front has a neckline.
    raster : which of the mesh's triangles is outermost in each cell, (rows, `UNROLLED_COLUMNS`); cells that none covers
        have the nearest one.
    covered : (rows, `UNROLLED_COLUMNS`) bool, which cells have one of their own.
    """

    name: str
    share: NDArray[np.float32]
    along: NDArray[np.float32]
    angle: NDArray[np.float32]
    raster: Raster
    covered: NDArray[np.bool_]
    yoke: int | None = None


@cache
def unrolled_parts() -> tuple[UnrolledPart, ...]:
    """Head, trunk, arms, legs and feet, once for the process."""
    mesh, human = template_mesh(), load_human()
    body = human.space.mean[mesh.ids].astype(np.float64)
    joint = dict(zip(human.space.names, human.space.joint_mean.astype(np.float64), strict=True))
    x, y, z = body.T
    found = []
    middle, along, radius = _head(mesh, body, joint)
    share = dict(zip(BODY_PARTS, mesh.parts.T, strict=True))
    found.append(_unrolled("head", mesh, share["head"], along, np.arctan2(x, z - middle), radius))
    spine = _axis([joint[name] for name in ("Hips", "Spine", "Spine1", "Spine2", "Neck")], 1, y)
    depth = z - spine[:, 2]
    legs = share["left_leg"] + share["right_leg"]
    crotch = float(y[share["torso"] > legs].min())
    hips = np.clip((y - crotch) / HIP_BLEND_METRES - 1, 0, 1) * legs  # both hips are one ring
    trunk = _unrolled("torso", mesh, share["torso"] + hips, y, np.arctan2(x, depth), np.hypot(x, depth))
    yoke = int(
        (joint["LeftArm"][1] - ARMPIT_DEPTH_METRES - float(y[trunk.share > MIN_UNROLLED_PART_WEIGHT].min()))
        / ROW_METRES
    )
    found.append(replace(trunk, yoke=yoke))
    for side in SIDE_NAMES:
        arm = [joint[side + name] for name in ("Arm", "ForeArm", "Hand", "HandMiddle1", "HandMiddle3")]
        centre = _axis(arm, 0, x)
        up, fore = y - centre[:, 1], z - centre[:, 2]
        name = f"{side.lower()}_arm"
        found.append(_unrolled(name, mesh, share[name], np.abs(x), np.arctan2(fore, up), np.hypot(up, fore)))
        toes = mesh.share(side + "Foot", side + "Toe")
        leg = [joint[side + name] for name in ("UpLeg", "Leg", "Foot")]
        centre = _axis(leg, 1, y)
        aside, fore = x - centre[:, 0], z - centre[:, 2]
        name = f"{side.lower()}_leg"
        own = share[name] * (1 - hips / np.maximum(legs, 1e-6)) - toes
        found.append(_unrolled(name, mesh, own, y, np.arctan2(aside, fore), np.hypot(aside, fore)))
        ankle, ball = joint[side + "Foot"], joint[side + "ToeBase"]
        centre = _axis([ankle * [1, 0.5, 1], ball], 2, z)
        aside, up = x - centre[:, 0], y - centre[:, 1]
        found.append(_unrolled(f"{side.lower()}_foot", mesh, toes, z, np.arctan2(aside, up), np.hypot(aside, up)))
    return tuple(found)


def _head(
    mesh: TemplateMesh, body: NDArray[np.float64], joint: dict[str, NDArray[np.float64]]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Of each vertex (V,): where the axis is at its height, how far along it, and how far from it: a cylinder below the eyes,
    a globe above."""
    own = body[mesh.head > 0.9]
    depth = (own[:, 2].min() + own[:, 2].max()) / 2 - 0.01
    level = float(body[mesh.eye, 1].mean())
    middle = np.interp(body[:, 1], [joint["Neck"][1], joint["Head"][1] + 0.03], [joint["Neck"][2], depth])
    away = np.hypot(body[:, 0], body[:, 2] - middle)
    above = body[:, 1] - level
    along = np.where(above > 0, level + CROWN_RADIUS_METRES * np.arctan2(above, away), body[:, 1])
    return middle, along, np.where(above > 0, np.hypot(above, away), away)


def _axis(points: Sequence[NDArray[np.float64]], along: int, at: NDArray[np.float64]) -> NDArray[np.float64]:
    """The points (V, 3) of a bent axis where its coordinate `along` has the values `at` (V,)."""
    places = np.stack(points)
    places = places[np.argsort(places[:, along])]
    return np.stack([np.interp(at, places[:, along], places[:, k]) for k in range(3)], 1)


def _unrolled(
    name: str,
    mesh: TemplateMesh,
    share: NDArray[np.floating],
    along: NDArray[np.float64],
    angle: NDArray[np.float64],
    radius: NDArray[np.float64],
) -> UnrolledPart:
    belongs = share > MIN_UNROLLED_PART_WEIGHT
    first = float(along[belongs].min())
    row = (along - first) / ROW_METRES
    rows = int(row[belongs].max()) + 2
    chosen = np.flatnonzero(belongs[mesh.triangles].all(1))
    corners = mesh.triangles[chosen]
    columns = unwrapped(angle[corners]) / (2 * np.pi) * UNROLLED_COLUMNS
    flat = np.ptp(columns, axis=1) < UNROLLED_COLUMNS / 2  # what lies round the end of the axis has no place
    chosen, corners, columns = chosen[flat], corners[flat], columns[flat]
    places = np.stack([columns + UNROLLED_COLUMNS / 2 - 0.5, row[corners] - 0.5, -radius[corners]], -1)
    copies = np.concatenate([places + np.array([turn * UNROLLED_COLUMNS, 0, 0]) for turn in (0, -1, 1)]).reshape(-1, 3)
    drawn = rasterise(copies, np.arange(len(copies)).reshape(-1, 3), (rows, UNROLLED_COLUMNS))
    covered = drawn.triangle >= 0
    which = np.where(covered, chosen[drawn.triangle % max(len(chosen), 1)], -1).astype(np.int32)
    wide = np.concatenate([covered, covered, covered], 1)
    y, x = (each[:, UNROLLED_COLUMNS : 2 * UNROLLED_COLUMNS] for each in nearest_in(wide))
    x = x % UNROLLED_COLUMNS
    raster = Raster(which[y, x], drawn.barycentrics[y, x], drawn.depth[y, x])
    return UnrolledPart(
        name, share.astype(np.float32), row.astype(np.float32), angle.astype(np.float32), raster, covered
    )


def unwrapped(angles: NDArray[np.floating]) -> NDArray[np.floating]:
    """Angles (T, 3) of the corners of triangles, none further than half a turn from the first one's."""
    first = angles[:, :1]
    return np.asarray(first + (angles - first + np.pi) % (2 * np.pi) - np.pi)
