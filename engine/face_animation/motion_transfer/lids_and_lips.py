"""Lids and lips as pairs that meet: closed on the driver is closed on the target.

Offsets carried between two faces leave gaps: a lid that closes on a small eye stops short on a large one.
So the gap between facing vertices is carried as a ratio for lids, and kept from turning inside out for lips.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.usual_lids import AS_AT_REST, UsualLids
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.landmarks import CHIN_VERTEX, FOREHEAD_VERTEX, LEFT_IRIS, RIGHT_IRIS, eye_opening

LID_EDGE_VERTEX_PAIRS = (
    *((246, 7), (161, 163), (160, 144), (159, 145), (158, 153), (157, 154), (173, 155)),
    *((466, 249), (388, 390), (387, 373), (386, 374), (385, 380), (384, 381), (398, 382)),
)
"""Facing vertices (upper, lower) of the lids' edges, right eye first."""
LID_SKIN_VERTEX_PAIRS = (
    *((247, 246), (30, 161), (29, 160), (27, 159), (28, 158), (56, 157), (190, 173)),
    *((467, 466), (260, 388), (259, 387), (257, 386), (258, 385), (286, 384), (414, 398)),
)
"""Vertices of the skin above the upper lid, each with the edge vertex that it follows half-way."""
INNER_LIP_PAIRS = ((191, 95), (80, 88), (81, 178), (82, 87), (13, 14), (312, 317), (311, 402), (310, 318), (415, 324))
"""Facing vertices (upper, lower) of the inner lips."""
LID_DIFFERENCE_SHARES = (0.25, 0.5)
"""Differences between the two eyes' gaps, as shares of their usual ones, up to which both open and close alike, and from which
on one winks. Lids are moved together (Hering's law); a tracker sees one of two that close a frame behind the other, and what
lies before an eye, a reflection or hair, as its lid."""
SHUT_GAP_SHARES = (0.2, 0.35)
"""How far the narrower eye is open, as a share of its usual gap. Below the first, each eye is as it is seen, so that one can
shut alone. Above the second, both may be made alike."""
MAX_GAP_RATIO = 1.5
"""An eye opens at most to this multiple of its gap in the picture."""
MAX_GAP_IRIS_DIAMETERS = 0.92
"""Diameters of its iris to which an eye opens at most: lids that are raised as far as they go bare some white above the
iris, and no ring around it."""
MIN_GAP_LIMIT = 1.08
"""Multiple of its gap up to which any eye opens, also a drawn one whose iris is small."""


def lid_ratio(
    meshes: NDArray[np.floating],
    neutral: NDArray[np.floating],
    target: NDArray[np.floating] | None = None,
    usual: UsualLids = AS_AT_REST,
) -> NDArray[np.float64]:
    """(N, 14) how far each pair of lid vertices is to open, against the picture: 1 in the neutral frame, and 0 where a gap is no wider than that of lids that
    meet. Which is more of a rest, the neutral frame or how eyes `usual`-ly are, is not known: between the one and half the way to the other
    they are as the picture has them.

    Eyes of a `target` (478, 3) open no farther than their irises allow. Those that are narrower at rest than the
    driver's are narrowed no further than these are, by `eye_opening`: what is left of wide eyes is not a squint.
    """
    upper, lower = np.array(LID_EDGE_VERTEX_PAIRS).T
    gap = np.linalg.norm(meshes[:, upper] - meshes[:, lower], axis=-1)
    rest = np.linalg.norm(neutral[upper] - neutral[lower], axis=-1)
    # an eye is judged as a whole by its middle, so that the corners do not flutter
    ratio = gap / np.maximum(rest, 1e-6)
    seen = np.stack([ratio[:, 2:5].mean(axis=1), ratio[:, 9:12].mean(axis=1)], axis=1)
    alike = _alike(seen / usual.opening) * usual.opening
    carried = np.clip(1, *np.sort([alike, alike / np.sqrt(usual.opening)], axis=0))
    ratio = ratio * np.repeat(carried / np.maximum(seen, 1e-6), 7, axis=1)
    opened = smoothstep(np.repeat(alike, 7, axis=1), usual.shut, usual.opened)
    if target is not None:
        ratio = np.minimum(ratio, np.repeat(gap_limits(target), 7))
        least = np.minimum(eye_opening(meshes) / np.maximum(eye_opening(target), 1e-6), 1)
        ratio = np.maximum(ratio, np.repeat(least, 7, axis=1))
    return np.asarray(np.clip(ratio, 0, MAX_GAP_RATIO) * opened, float)


def gap_limits(target: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2,) to what multiple of its gap in the picture each eye of a `target` (478, 2 or 3) opens at most, the right one first."""
    upper, lower = np.array(LID_EDGE_VERTEX_PAIRS).T.reshape(2, 2, 7)[:, :, 2:5]
    gaps = np.linalg.norm(target[upper] - target[lower], axis=-1).mean(axis=1)
    rings = np.array([RIGHT_IRIS, LEFT_IRIS])
    iris = 2 * np.linalg.norm(target[rings[:, 1:]] - target[rings[:, :1]], axis=-1).mean(axis=1)
    return np.asarray(np.clip(MAX_GAP_IRIS_DIAMETERS * iris / np.maximum(gaps, 1e-6), MIN_GAP_LIMIT, MAX_GAP_RATIO))


def _alike(gaps: NDArray[np.floating]) -> NDArray[np.floating]:
    """The gaps (N, 2) of right and left eyes, the same for both where they open and close together."""
    mean = gaps.mean(axis=1, keepdims=True)
    alike = 1 - smoothstep(np.abs(gaps[:, :1] - gaps[:, 1:]), *LID_DIFFERENCE_SHARES)
    alike *= smoothstep(gaps.min(axis=1, keepdims=True), *SHUT_GAP_SHARES)
    return gaps + alike * (mean - gaps)


def constrain_lids_and_lips(
    positions: NDArray[np.floating],
    target: NDArray[np.floating],
    ratio: NDArray[np.floating],
    bare: NDArray[np.floating],
) -> NDArray[np.float64]:
    """Put lids and lips where they belong.

    Parameters
    ----------
    positions : (N, 478, 3) the target's mesh with the expression on, before the head moves, pixels.
    target : (478, 3) its mesh at rest. ratio : (N, 14) from `lid_ratio`, 1 at rest. bare : (478,) how far each vertex may move by itself, in [0, 1].

    Returns
    -------
    (N, 478, 3).
    """
    out = positions.astype(float)
    upper, lower = np.array(LID_EDGE_VERTEX_PAIRS).T
    wanted = out[:, lower] + ratio[..., None] * (target[upper] - target[lower])
    moved = wanted - out[:, upper]
    out[:, upper] = wanted
    skin, edge = np.array(LID_SKIN_VERTEX_PAIRS).T
    index = {int(v): i for i, v in enumerate(upper)}
    out[:, skin] += 0.5 * bare[skin, None] * moved[:, [index[int(v)] for v in edge]]
    top, bottom = np.array(INNER_LIP_PAIRS).T
    down = target[CHIN_VERTEX] - target[FOREHEAD_VERTEX]
    down = down / np.linalg.norm(down)
    gap = (out[:, bottom] - out[:, top]) @ down
    overlap = np.maximum(-gap, 0)[..., None] * down / 2
    out[:, top] -= overlap
    out[:, bottom] += overlap
    return out


def open_lids(placed: NDArray[np.floating], rigid: NDArray[np.floating], ratio: NDArray[np.floating]) -> None:
    """Have lids as far open as they are told to be where the face ended up, in place. What evens out a contour or corrects a point may have parted lids that
    meet, raised them too far, or drawn down one of two that open alike.

    Parameters
    ----------
    placed : (N, 478, 2) the face, pixels. rigid : (N, 478, 2) where the head alone carries its rest. ratio : (N, 14) from `lid_ratio`.
    """
    upper, lower = np.array(LID_EDGE_VERTEX_PAIRS).T
    placed[:, upper] = placed[:, lower] + ratio[..., None] * (rigid[:, upper] - rigid[:, lower])
