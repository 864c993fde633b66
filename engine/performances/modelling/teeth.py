"""The actor's teeth and gums: crowns lofted one by one along the dental arch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

UPPER_CROWNS = ((8.3, 10.0), (6.4, 9.1), (7.3, 9.5), (6.8, 8.3), (6.6, 7.8), (9.6, 7.0), (9.2, 6.6))
LOWER_CROWNS = ((5.1, 8.6), (5.6, 8.8), (6.5, 9.0), (6.7, 8.2), (6.8, 7.6), (10.4, 6.8), (9.8, 6.6))
"""Width and height in millimetres of the crowns from the middle outwards: incisors, canine, premolars, molars.
After M. Ash, S. Nelson, Wheeler's Dental Anatomy, scaled to the template's head."""

CROWN_HALF_DEPTHS = (3.3, 3.2, 3.9, 4.3, 4.5, 5.0, 5.0)
"""Half thickness at the gum, millimetres."""


@dataclass(frozen=True)
class Dentition:
    """One jaw's teeth and gum in the rest pose.

    vertices : (V, 3) metres.
    triangles : (T, 3).
    enamel : (V,) height on the crown from the gum, 0, to the edge, 1; -1 on the gum.
    shade : (V,) each tooth's own brightness.
    """

    vertices: NDArray[np.float32]
    triangles: NDArray[np.int32]
    enamel: NDArray[np.float32]
    shade: NDArray[np.float32]


@dataclass(frozen=True)
class Arch:
    """Where a row of teeth stands: the front of the arch (y of the gum line, z of the front), metres. `up` is 1 where
    the crowns point up (lower jaw), -1 where they point down."""

    gum: float
    front: float
    up: int

    def place(self, length: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points (N, 2) (x, z) at arc lengths from the middle, and the outward directions there (N, 2)."""
        steps = np.linspace(0, 1.62, 600)
        width, depth = (0.0258, 0.0375) if self.up < 0 else (0.0242, 0.0352)
        x = width * np.sin(steps) ** 0.92
        z = self.front - depth * (1 - np.cos(steps)) ** 1.08
        arc = np.concatenate([[0], np.cumsum(np.hypot(np.diff(x), np.diff(z)))])
        side = np.sign(length) + (np.asarray(length) == 0)
        at = np.abs(length)
        px, pz = np.interp(at, arc, x), np.interp(at, arc, z)
        dx, dz = np.interp(at, arc, np.gradient(x, arc)), np.interp(at, arc, np.gradient(z, arc))
        return np.stack([side * px, pz], -1), np.stack([side * -dz, dx], -1)


def build_dentition(arch: Arch, detail: float = 1.0, seed: int = 3, unevenness: float = 1.0) -> Dentition:
    """The crowns and the gum of one jaw; `detail` scales the fineness of the mesh, not its shape, `unevenness` by how much single
    crowns are tilted, longer and further out than their neighbours."""
    rng = np.random.default_rng(seed)
    sizes = UPPER_CROWNS if arch.up < 0 else LOWER_CROWNS
    pieces = []
    for side in (-1, 1):
        reached = 0.0
        for number, (width, height) in enumerate(sizes):
            middle = reached + width / 2000
            reached += width / 1000 * 0.985
            pieces.append(_crown(arch, side * middle, width / 2000, height / 1000, number, detail, rng, unevenness))
    pieces.append(_gum(arch, sizes, detail))
    counts = np.cumsum([0, *(len(p[0]) for p in pieces)])
    return Dentition(
        vertices=np.concatenate([p[0] for p in pieces]).astype(np.float32),
        triangles=np.concatenate([p[1] + n for p, n in zip(pieces, counts, strict=False)]).astype(np.int32),
        enamel=np.concatenate([p[2] for p in pieces]).astype(np.float32),
        shade=np.concatenate([np.full(len(p[0]), p[3]) for p in pieces]).astype(np.float32),
    )


Piece = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64], float]


def _crown(
    arch: Arch, middle: float, half: float, height: float, number: int, detail: float, rng: np.random.Generator,
    unevenness: float,
) -> Piece:  # fmt: skip
    """One crown: rounded sections stacked from under the gum to the biting edge."""
    levels, sectors = round(18 * detail), round(28 * detail)
    t = np.linspace(-0.25, 1, levels)[:, None]
    turn = np.linspace(0, 2 * np.pi, sectors, endpoint=False)[None]
    depth = CROWN_HALF_DEPTHS[number] / 1000
    grown = np.clip(t, 0, 1)
    edge = np.sqrt(np.clip(1 - ((grown - 0.90) / 0.10).clip(0) ** 2, 0, 1))  # the last tenth is rounded off
    if number < 2:
        a = half * (0.80 + 0.20 * np.sin(np.pi / 2 * np.minimum(grown / 0.75, 1)))
        b = depth * (1 - 0.80 * grown**0.8)
        a, b = a * (0.84 + 0.16 * edge), b * (0.35 + 0.65 * edge)
    elif number == 2:
        a = half * (0.84 + 0.18 * np.sin(np.pi * grown**0.8)) * (1 - 0.42 * grown**5)
        b = depth * (1 - 0.72 * grown) * (0.3 + 0.7 * edge)
    else:
        a = half * (0.88 + 0.12 * np.sin(np.pi * grown)) * (0.8 + 0.2 * edge)
        b = depth * (0.92 + 0.12 * np.sin(np.pi * grown)) * (1 - 0.28 * grown) * (0.75 + 0.25 * edge)
    cos, sin = np.cos(turn), np.sin(turn)
    power = 2 / 2.7
    across = a * np.sign(cos) * np.abs(cos) ** power
    out = b * np.sign(sin) * np.abs(sin) ** power
    lean = 0.0022 * (grown - 0.35 * grown**2) - 0.0011  # crowns lean outwards and curve back to the edge
    tilt = np.radians(unevenness * rng.normal(0, 1.6))
    height = height * (1 + unevenness * rng.normal(0, 0.012))
    along_height = t * height * (1 - 0.03 * (across / half) ** 2)
    across, along_height = across * np.cos(tilt) - along_height * np.sin(tilt), along_height + across * np.sin(tilt)
    place, outward = arch.place(np.array([middle]))
    push = unevenness * rng.normal(0, 0.00018)
    dx, dz = outward[0]
    distance = out - b.max() * 0.55 + lean + push
    x = place[0, 0] + distance * dx + across * dz
    z = place[0, 1] + distance * dz - across * dx
    y = arch.gum + arch.up * (along_height + _gum_rise(arch, middle))
    points = np.stack([x, y, np.broadcast_to(z, x.shape)], -1)
    tip = points[-1].mean(0)
    index = np.arange(levels * sectors).reshape(levels, sectors)
    after = np.roll(index, -1, 1)
    triangles = np.concatenate(
        [
            np.stack([index[:-1], after[:-1], after[1:]], 2).reshape(-1, 3),
            np.stack([index[:-1], after[1:], index[1:]], 2).reshape(-1, 3),
            np.stack([index[-1], after[-1], np.full(sectors, levels * sectors)], 1),
        ]
    )
    if arch.up > 0:
        triangles = triangles[:, ::-1]
    enamel = np.concatenate([np.broadcast_to(grown, index.shape).ravel(), [1.0]])
    return np.concatenate([points.reshape(-1, 3), tip[None]]), triangles, enamel, 1 + rng.normal(0, 0.025)


def _gum_rise(arch: Arch, middle: float) -> float:
    """The row of edges curves: its ends lie nearer to the gum's side than its middle."""
    return -0.0012 * (abs(middle) / 0.03) ** 2 * (1 if arch.up < 0 else 0.4)


def _gum(arch: Arch, sizes: tuple[tuple[float, float], ...], detail: float) -> Piece:
    """The gum as a ribbon in front of the roots, scalloped around each crown."""
    borders = np.cumsum([0, *(w / 1000 * 0.985 for w, _ in sizes)])
    length = np.linspace(-borders[-1], borders[-1], round(420 * detail) + 1)
    inside = np.searchsorted(borders, np.abs(length), side="right").clip(1, len(sizes)) - 1
    phase = (np.abs(length) - borders[inside]) / (borders[inside + 1] - borders[inside])
    scallop = 0.0016 * (1 - (2 * phase - 1) ** 2) ** 0.8
    place, outward = arch.place(length)
    rise = np.array([_gum_rise(arch, value) for value in length])
    rows = []
    for drop, bulge in (
        (0.0, -0.0012),
        (0.0, 0.0001),
        (0.0007, 0.0010),
        (0.003, 0.0014),
        (0.010, 0.0006),
        (0.014, -0.003),
    ):
        foot = (scallop if drop < 0.003 else 0.3 * scallop) - 0.0011
        y = arch.gum - arch.up * (drop + foot) + arch.up * rise
        rows.append(np.stack([place[:, 0] + bulge * outward[:, 0], y, place[:, 1] + bulge * outward[:, 1]], 1))
    points = np.stack(rows)
    index = np.arange(points.shape[0] * points.shape[1]).reshape(points.shape[:2])
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], 2).reshape(-1, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    if arch.up > 0:
        triangles = triangles[:, ::-1]
    return points.reshape(-1, 3), triangles, np.full(index.size, -1.0), 1.0
