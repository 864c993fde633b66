"""The actor's eyes: eyeballs with a bulging cornea, an iris seen through it, and lids that ride on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

EYEBALL_RADIUS_METRES = 0.0147
"""Metres. The template's eyes are a little larger than life; the iris is not."""

IRIS_RADIUS = 0.0056
"""Radius of the iris and of the cornea's rim."""

PUPIL_RADIUS = 0.0021

CORNEA_RADIUS = 0.0074
"""Radius of curvature of the cornea: 7.8 mm in life."""

IRIS_DEPTH = 0.0007
"""How far the iris lies behind the cornea's rim."""

REFRACTIVE_INDEX = 1.336
"""Index of refraction of the eye's watery humour."""

_RIM_DEPTH = np.sqrt(EYEBALL_RADIUS_METRES**2 - IRIS_RADIUS**2)
_CORNEA_CENTRE = _RIM_DEPTH - np.sqrt(CORNEA_RADIUS**2 - IRIS_RADIUS**2)


def profile(cosine: NDArray[np.floating]) -> NDArray[np.float64]:
    """Distance of the eye's surface from its centre, by the cosine of the angle to the direction of gaze."""
    c = np.asarray(cosine, np.float64)
    inside = np.maximum(CORNEA_RADIUS**2 - _CORNEA_CENTRE**2 * (1 - c**2), 0)
    return np.maximum(EYEBALL_RADIUS_METRES, np.where(c > 0.8, _CORNEA_CENTRE * c + np.sqrt(inside), 0.0))


@dataclass(frozen=True)
class Eyeball:
    """The eyeball about the origin, looking along +z: `vertices` (V, 3), `triangles` (T, 3)."""

    vertices: NDArray[np.float32]
    triangles: NDArray[np.int32]


def build_eyeball(rings: int = 56, sectors: int = 96) -> Eyeball:
    """The front of an eyeball as a surface of revolution, finest around the cornea."""
    angle = np.radians(105) * np.linspace(0, 1, rings) ** 1.3
    turn = np.linspace(0, 2 * np.pi, sectors, endpoint=False)
    radius = profile(np.cos(angle))
    around, out = np.meshgrid(turn, angle)
    r = np.broadcast_to(radius[:, None], around.shape)
    points = np.stack([r * np.sin(out) * np.cos(around), r * np.sin(out) * np.sin(around), r * np.cos(out)], 2)
    index = np.arange(rings * sectors).reshape(rings, sectors)
    after = np.roll(index, -1, 1)
    quads = np.stack([index[:-1], index[1:], after[1:], after[:-1]], 2).reshape(-1, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Eyeball(points.reshape(-1, 3).astype(np.float32), triangles.astype(np.int32))


def colour_of_eye(
    points: NDArray[np.floating], view: NDArray[np.floating], seed: int = 5
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """What colour is seen at points of the eyeball.

    Parameters
    ----------
    points : (N, 3) on the surface, in the eye's own axes (it looks along +z).
    view : (N, 3) unit vectors towards the camera, in the same axes.

    Returns
    -------
    albedo (N, 3) float32 linear, and (N,) float32 how much of the point is iris or pupil [0, 1].
    """
    rho = np.hypot(points[:, 0], points[:, 1])
    through = _on_iris(points, view)
    seen = np.hypot(through[:, 0], through[:, 1])
    cornea = 1 - _ramp(rho, IRIS_RADIUS - 0.00045, IRIS_RADIUS + 0.00040)
    iris = _iris(through, seen, np.random.default_rng(seed))
    white = _sclera(points, np.random.default_rng(seed + 1))
    albedo = white + cornea[:, None] * (iris - white)
    return albedo.astype(np.float32), cornea.astype(np.float32)


def _on_iris(points: NDArray[np.floating], view: NDArray[np.floating]) -> NDArray[np.float64]:
    """Where the line of sight, refracted by the cornea, meets the plane of the iris: (N, 2)."""
    normal = np.asarray(points, np.float64) - [0, 0, _CORNEA_CENTRE]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    cosine = np.clip((normal * view).sum(1, keepdims=True), 0.05, 1)
    ratio = 1 / REFRACTIVE_INDEX
    inner = np.sqrt(1 - ratio**2 * (1 - cosine**2))
    ray = -ratio * view + (ratio * cosine - inner) * normal
    depth = (_RIM_DEPTH - IRIS_DEPTH - points[:, 2]) / np.minimum(ray[:, 2], -0.05)
    return points[:, :2] + depth[:, None] * ray[:, :2]


def _iris(place: NDArray[np.floating], rho: NDArray[np.floating], rng: np.random.Generator) -> NDArray[np.float64]:
    """Hazel-brown: a warm collar around the pupil, radial fibres, a dark rim."""
    t = (rho - PUPIL_RADIUS) / (IRIS_RADIUS - PUPIL_RADIUS)
    turn = np.arctan2(place[:, 1], place[:, 0])
    waves = [(int(k), rng.uniform(0, 2 * np.pi), rng.uniform(0.5, 1)) for k in rng.integers(18, 90, 26)]
    fibres = sum(a * np.cos(k * turn + phase + 2.5 * np.sin(3 * t + phase)) for k, phase, a in waves) / 5.0
    outer, collar = np.array([0.115, 0.075, 0.040]), np.array([0.21, 0.105, 0.040])
    colour = collar + _ramp(t, 0.12, 0.5)[:, None] * (outer - collar)
    colour = colour * np.clip(1 + 0.35 * fibres, 0.35, 1.9)[:, None]
    colour = colour * (1 - 0.75 * _ramp(t, 0.74, 1.0))[:, None]
    return colour * _ramp(rho, PUPIL_RADIUS - 0.00018, PUPIL_RADIUS + 0.00018)[:, None] + 0.003


def _sclera(points: NDArray[np.floating], rng: np.random.Generator) -> NDArray[np.float64]:
    """Off-white, redder towards the corners, with a few vessels."""
    corner = _ramp(np.abs(points[:, 0]), 0.0055, 0.0128)
    colour = np.array([0.70, 0.655, 0.61]) * (1 - corner[:, None] * np.array([0.10, 0.30, 0.32]))
    vessels = np.zeros(len(points))
    for _ in range(26):
        start, side = rng.uniform(-0.006, 0.006), rng.choice([-1, 1])
        bend, wave, phase = rng.uniform(-0.5, 0.5), rng.uniform(600, 1400), rng.uniform(0, 6.28)
        x = points[:, 0] * side
        path = start + bend * (0.013 - x) + 0.0004 * np.sin(wave * x + phase)
        width = 0.00013 * rng.uniform(0.6, 1.3)
        reach = _ramp(x, rng.uniform(0.005, 0.009), 0.0125)
        vessels = np.maximum(vessels, reach * np.exp(-0.5 * ((points[:, 1] - path) / width) ** 2))
    colour = colour * (1 - vessels[:, None] * np.array([0.12, 0.45, 0.42]))
    rim = np.exp(-0.5 * ((np.hypot(points[:, 0], points[:, 1]) - IRIS_RADIUS) / 0.0009) ** 2)
    return colour * (1 - 0.25 * rim)[:, None]


def _ramp(value: NDArray[np.floating], low: float, high: float) -> NDArray[np.float64]:
    t = np.clip((np.asarray(value, np.float64) - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)
