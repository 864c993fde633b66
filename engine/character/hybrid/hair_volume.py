"""Hair that stands off the head or falls from it: a shell of its own around the template's head, open before the face.

Beyond the paper, whose head is a relief: with long hair that is a hood with a face before it, and from its side there is none. The picture
says how wide hair is at each height and what of it is before the neck; around the back it is as far from the head as it is at the sides,
and hangs down.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.character.hybrid.hair_colours import hair_round
from engine.character.hybrid.hair_rings import BEHIND_THE_EAR_RADIANS, HairRings, hair_rings
from engine.character.shell.piece import Colours, Piece
from engine.character.shell.template_mesh import TemplateMesh

SURE_HEAD_WEIGHT = 0.9
"""Weight of the head from which on a vertex is the skull's."""
RING_VERTICES = 40
"""Vertices of each of the two walls in a row, half of them on each side."""
MIN_HAIR_ROWS = 8
"""Rows of hair that are worth a volume."""
HAIR_THICKNESS_PIXELS, MAX_THICKNESS_SHARE = 4.0, 0.4
"""Pixels between its walls, at most, and the same as a share of its width."""
MIN_RADIUS_PIXELS = 0.3
"""Of a ring, where it closes."""
HEAD_HAIR_SHARE, TRUNK_HAIR_SHARE = 0.35, 0.75
"""How far below the chin, as a share of the head's height, hair moves with the head alone; how much of it moves with the trunk from twice as far on."""


def hair_volume(
    mesh: TemplateMesh,
    pictured: NDArray[np.float64],
    rgb: NDArray[np.uint8],
    to_grid: NDArray[np.float64],
    hair: NDArray[np.bool_],
    front: NDArray[np.float32],
    back: NDArray[np.float32],
    face: NDArray[np.floating],
) -> Piece | None:
    """The shell of hair around a head; None where there is too little.

    Parameters
    ----------
    pictured : (V, 3), the shell's vertices.
    rgb : (H, W, 3), the picture; `to_grid` (2, 3) takes its pixels to those of the grid.
    hair : (h, w), what of the grid shows hair.
    front, back : (h, w), how near and how far what is shown of the person besides reaches, z of picture space, infinite where nothing is.
    face : (5,), the ellipse around the face.
    """
    if int(hair.any(1).sum()) < MIN_HAIR_ROWS:
        return None
    skull = pictured[mesh.head > SURE_HEAD_WEIGHT]
    of = hair_rings(hair, skull, front, back, float(face[0]))
    angles = _angles(of)
    outer = _ring(of, angles, np.zeros((len(of.rows), 1)))
    thick = np.minimum(HAIR_THICKNESS_PIXELS, MAX_THICKNESS_SHARE * (of.right - of.left))
    loop = np.concatenate([outer, _ring(of, angles, thick[:, None])[:, ::-1]], 1)
    vertices = loop.reshape(-1, 3)
    bones, weights = _carried(mesh, skull, vertices)
    column, row = np.meshgrid(np.linspace(0, 1, RING_VERTICES), np.linspace(0, 1, len(of.rows)))
    places = np.stack([column, row], 2)
    places = np.concatenate([places, places[:, ::-1]], 1).reshape(-1, 2)
    seen = hair_round(rgb, to_grid, hair, outer[..., :2], angles)
    return Piece("Head", vertices, _walls(len(of.rows)), bones, weights, Colours(places, seen))


def _angles(of: HairRings) -> NDArray[np.float64]:
    """The angles (R, N) of a ring's vertices, radians from the front, from where hair ends on the right around the back to the left."""
    meets = of.meets[:, None]
    alone = (np.pi - meets) / (np.pi - BEHIND_THE_EAR_RADIANS)  # 1 where hair is on the right alone, -1 on the left
    right, left = (of.opening(one)[:, None] for one in (True, False))
    right, left = (
        right + np.clip(-alone, 0, 1) * (meets - right),
        left + np.clip(alone, 0, 1) * (2 * np.pi - meets - left),
    )
    along = np.linspace(0, 1, RING_VERTICES // 2)
    halves = [right + along * (meets - right), meets + along * (2 * np.pi - left - meets)]
    return np.asarray(np.concatenate(halves, 1))  # behind, both sides have a vertex of their own


def _ring(of: HairRings, angles: NDArray[np.float64], inwards: NDArray[np.float64]) -> NDArray[np.float64]:
    """The vertices (R, N, 3) at some angles (R, N), so many pixels (R, 1) within the outline."""
    across, along = np.sin(angles), np.cos(angles)
    left, right = of.half(False)[:, None], of.half(True)[:, None]
    radius = np.maximum(np.where(across > 0, right, left) - inwards, MIN_RADIUS_PIXELS)
    ahead, behind = (of.near - of.middle)[:, None], (of.middle - of.far)[:, None]
    deep = np.maximum(np.where(along > 0, ahead, behind) - inwards, MIN_RADIUS_PIXELS)
    rows = np.broadcast_to(of.rows[:, None], angles.shape)
    return np.stack([of.axis + radius * across, rows, of.middle + deep * along], 2)


def _walls(rows: int) -> NDArray[np.int32]:
    """Triangles of a tube of so many loops of twice `RING_VERTICES` vertices, closed at its first and last."""
    around = 2 * RING_VERTICES
    ring = np.arange(rows * around).reshape(rows, around)
    upper, lower = ring[:-1], ring[1:]
    following, below = np.roll(upper, -1, 1), np.roll(lower, -1, 1)
    sides = [
        np.stack([upper, lower, below], -1).reshape(-1, 3),
        np.stack([upper, below, following], -1).reshape(-1, 3),
    ]
    a = np.arange(RING_VERTICES - 1)
    cap = np.concatenate(
        [np.stack([a, a + 1, around - 1 - a], 1), np.stack([a + 1, around - 2 - a, around - 1 - a], 1)]
    )
    return np.concatenate([*sides, cap, cap[:, ::-1] + (rows - 1) * around]).astype(np.int32)


def _carried(
    mesh: TemplateMesh, skull: NDArray[np.float64], places: NDArray[np.float64]
) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """(N, 4) joints and (N, 4) weights: the head above, and further and further down the trunk."""
    chin, height = skull[:, 1].max(), np.ptp(skull[:, 1])
    down = np.clip((places[:, 1] - chin) / (HEAD_HAIR_SHARE * height) - 1, 0, 1)
    share = TRUNK_HAIR_SHARE * down * down * (3 - 2 * down)
    weights = np.stack([1 - share, share, 0 * share, 0 * share], 1)
    names = [mesh.names.index(name) for name in ("Head", "Spine2", "Head", "Head")]
    return np.tile(np.array(names, np.intp), (len(places), 1)), weights.astype(np.float32)
