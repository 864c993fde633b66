"""Brows and lashes: hairs that are rooted in the skin and follow it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.geometry.mesh.surface import triangulate
from engine.performances.modelling.chart import smooth_curve
from engine.performances.modelling.eyes import Eyeball
from engine.performances.modelling.figure import Figure
from engine.performances.modelling.lids import find_rim

BROW_LINE = [(0.0090, 0.8040), (0.0155, 0.8060), (0.0250, 0.8082), (0.0345, 0.8090), (0.0425, 0.8072), (0.0490, 0.8032)]
"""The middle line of the sitter's left brow on the map of the head."""


@dataclass(frozen=True)
class RootedHairs:
    """S hairs of K points, rooted in the fine skin.

    corners : (S, 3) int32, the vertices of the triangle at each root.
    share : (S, 3) float32, the root's barycentrics there.
    offsets : (S, K, 3) float32 metres from the root along its own frame: sideways to the sitter's left, up, out.
    widths : (S, K) float32 metres.
    eye : (S,) int8, 0 or 1: the eye whose centre gives the direction out; -1 where the skin's normal does.
    """

    corners: NDArray[np.int32]
    share: NDArray[np.float32]
    offsets: NDArray[np.float32]
    widths: NDArray[np.float32]
    eye: NDArray[np.int8]


def place_hairs(
    rooted: RootedHairs, skin: NDArray[np.floating], normals: NDArray[np.floating], eyes: NDArray[np.floating]
) -> NDArray[np.float32]:
    """The hairs on the posed skin (N, 3) with its normals: (S, K, 3). `eyes` (2, 3) are the eyes' centres."""
    roots = (skin[rooted.corners] * rooted.share[..., None]).sum(1)
    out = (normals[rooted.corners] * rooted.share[..., None]).sum(1)
    at_eye = rooted.eye >= 0
    out[at_eye] = roots[at_eye] - eyes[rooted.eye[at_eye]]
    out = out / np.linalg.norm(out, axis=1, keepdims=True)
    up = np.array([0.0, 1.0, 0.0]) - out[:, 1:2] * out
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    frame = np.stack([np.cross(up, out), up, out], 1)
    return (roots[:, None] + np.einsum("skf,sfx->skx", rooted.offsets, frame)).astype(np.float32)


def grow_brows(figure: Figure, chart: NDArray[np.floating], count: int = 640, seed: int = 21) -> RootedHairs:
    """Both brows; `chart` (N, 2) places the fine skin's vertices on the map of the head."""
    rng = np.random.default_rng(seed)
    middle = smooth_curve(BROW_LINE)
    ahead = np.gradient(middle, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    place, offsets = [], []
    for side in (1, -1):
        t = rng.beta(1.15, 1.25, count)
        at = (t * (len(middle) - 1)).astype(int)
        half = np.interp(t, [0, 0.08, 0.35, 0.65, 1], [0.0030, 0.0042, 0.0041, 0.0034, 0.0013])
        across = np.clip(rng.normal(0, 0.48, count), -1.1, 1.1)
        normal = np.stack([-ahead[at, 1], ahead[at, 0]], 1)
        spot = middle[at] + (across * half)[:, None] * normal + rng.normal(0, 0.0003, (count, 2))
        # hairs stand up at the inner end, lie outwards further on; the upper ones point down, the lower ones up
        angle = np.radians(np.interp(t, [0, 0.12, 0.35, 0.7, 1], [78, 60, 30, 8, -4])) - across * 0.42
        angle = angle + rng.normal(0, 0.13, count)
        length = np.interp(t, [0, 0.15, 0.6, 1], [0.0055, 0.0078, 0.0074, 0.0052]) * np.exp(rng.normal(0, 0.15, count))
        turn = np.arctan2(ahead[at, 1], ahead[at, 0])
        steps = np.linspace(0, 1, 6)[None]
        bend = angle[:, None] * (1 - 0.45 * steps) + turn[:, None]
        run = length[:, None] / 5
        x = np.concatenate([np.zeros((count, 1)), np.cumsum(run * np.cos(bend[:, 1:]), 1)], 1)
        y = np.concatenate([np.zeros((count, 1)), np.cumsum(run * np.sin(bend[:, 1:]), 1)], 1)
        lift = 0.0002 + 0.0009 * np.sin(np.pi * 0.7 * steps) * rng.uniform(0.4, 1, (count, 1))
        place.append(spot * [side, 1])
        offsets.append(np.stack([side * x, y, lift], 2))
    corners, share = _bind(figure, chart, np.concatenate(place))
    grown = np.concatenate(offsets).astype(np.float32)
    taper = np.array([0.8, 1, 1, 0.85, 0.6, 0.25])
    widths = taper[None] * rng.normal(1.05e-4, 1.5e-5, (len(grown), 1))
    return RootedHairs(corners, share, grown, widths.astype(np.float32), np.full(len(grown), -1, np.int8))


def grow_lashes(figure: Figure, eyeball: Eyeball, seed: int = 22) -> RootedHairs:
    """The lashes of all four lids, rooted where the skin ends in front of the eyeball."""
    rng = np.random.default_rng(seed)
    parts = [_lashes(rng, figure, eyeball, eye, upper) for eye in (0, 1) for upper in (True, False)]
    corners, share, offsets, widths, eyes = (np.concatenate(column) for column in zip(*parts, strict=True))
    return RootedHairs(corners, share, offsets.astype(np.float32), widths.astype(np.float32), eyes)


def _lashes(
    rng: np.random.Generator, figure: Figure, eyeball: Eyeball, eye: int, upper: bool
) -> tuple[NDArray, NDArray, NDArray, NDArray, NDArray]:
    t = np.sort(rng.uniform(0.02, 0.98, 190 if upper else 70))
    skin = (figure.fine @ figure.rest).astype(np.float32)
    rim = find_rim(skin, triangulate(figure.quads), eyeball, figure.eyes[eye].centre, upper, t)
    count = len(t)
    outer = t if eye == 0 else 1 - t  # 0 at the nose, 1 at the temple
    if upper:
        length = np.interp(outer, [0, 0.2, 0.6, 0.85, 1], [0.0028, 0.0050, 0.0066, 0.0070, 0.0050])
        rise, curl = rng.normal(-0.12, 0.10, count), rng.normal(0.75, 0.12, count)
    else:
        length = np.interp(outer, [0, 0.2, 0.6, 0.85, 1], [0.0018, 0.0032, 0.0042, 0.0046, 0.0032])
        rise, curl = rng.normal(-0.55, 0.12, count), rng.normal(-0.35, 0.12, count)
    length = length * np.exp(rng.normal(0, 0.14, count))
    fan = (np.interp(outer, [0, 0.5, 1], [-0.45, 0.05, 0.75]) + rng.normal(0, 0.10, count)) * (1 if eye == 0 else -1)
    steps = np.linspace(0, 1, 6)[None]
    up = rise[:, None] + curl[:, None] * steps
    run = length[:, None] / 5
    out = np.cumsum(run * np.cos(up), 1) - run * np.cos(up[:, :1])
    high = np.cumsum(run * np.sin(up), 1) - run * np.sin(up[:, :1])
    offsets = np.stack([out * np.sin(fan)[:, None], high, out * np.cos(fan)[:, None] + 0.0001], 2)
    widths = np.array([1.0, 1.0, 0.85, 0.65, 0.45, 0.2])[None] * rng.normal(
        1.25e-4 if upper else 0.8e-4, 1e-5, (count, 1)
    )
    return rim.corners, rim.share, offsets, widths, np.full(count, eye, np.int8)


def _bind(
    figure: Figure, chart: NDArray[np.floating], place: NDArray[np.floating]
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """The triangles of the outermost skin at places (S, 2) of the map, and the barycentrics there."""
    triangles = triangulate(figure.quads)
    near = np.flatnonzero(
        (chart[triangles, 0].min(1) > place[:, 0].min() - 0.01)
        & (chart[triangles, 0].max(1) < place[:, 0].max() + 0.01)
        & (chart[triangles, 1].min(1) > place[:, 1].min() - 0.01)
        & (chart[triangles, 1].max(1) < place[:, 1].max() + 0.01)
    )
    corners = triangles[near]
    a, b, c = (chart[corners[:, k]].astype(np.float64) for k in range(3))
    _, candidates = cKDTree((a + b + c) / 3).query(place, k=12)
    candidates = np.asarray(candidates)
    p = place[:, None]
    a, b, c = a[candidates], b[candidates], c[candidates]
    area = _cross(b - a, c - a)
    share = np.stack([_cross(b - p, c - p), _cross(c - p, a - p), _cross(a - p, b - p)], 2) / area[..., None]
    best = share.min(2).argmax(1)
    rows = np.arange(len(place))
    return corners[candidates[rows, best]], share[rows, best].astype(np.float32)


def _cross(a: NDArray[np.floating], b: NDArray[np.floating]) -> NDArray[np.floating]:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
