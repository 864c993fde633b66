"""How dark an eyeball is beneath its lids: which share of the light from above and before it the face and its lashes let through."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.texture.views import ChartedSurface
from engine.geometry.camera import Camera
from engine.render.rasterisation.rasteriser import depth_map
from engine.render.textures.sampling import bilinear

LIGHT_DIRECTION_COUNT = 24
"""Directions from which light comes, evenly over the half of the sky before the face, more of it from above."""
LIGHT_DISTANCE, LIGHT_PICTURE_PIXELS, LIGHT_PICTURE_METRES = 0.5, 240, 0.06
"""Metres to a light, and the pixels and the metres at the eye that its picture of the face is wide."""
OCCLUSION_TOLERANCE_METRES = 8e-4
"""Metres behind the surface at which a point still has a light."""
LEVEL_LIGHT_SHARE = 0.3
"""What light from level with the eye counts beside that from straight above, less that."""
MIN_LIGHT_SHARE = 0.5
"""What is left of the light where none of the sky is seen: skin lets some through, and the ball shines back."""
LASH_SHADOW_SHARE, LASH_SHADOW_METRES = 0.45, 0.0016
"""Of the light, what lashes take right beneath the upper lid, and metres below it at which they take a third of that."""
HIDDEN_SHADOW_FADE_METRES, SEEN_POINT_STEP = 0.0015, 16
"""Metres over which a shadow ends where lids hide an eyeball, and each how many of the seen points are asked for the nearest."""
SHADOW_END_LENGTHS = 4.0
"""Such lengths away nothing is left of a shadow."""
SHADOW_RIM_STEPS = 12
"""Places between two vertices of a rim from which it is measured."""
MIN_SEEN_LIGHT_SHARE = 0.05
"""Of the most light that any point has, below which a point is hidden behind a lid."""


def lid_shadow(surface: ChartedSurface, points: NDArray[np.float64], gaze: NDArray[np.float64]) -> NDArray[np.float32]:
    """(N,) what an eyeball's colours at `points` (N, 3) are multiplied by. It is 1 where at least as much light comes
    as on average over what lids leave to be seen, from which the colours are. It goes over to 1 where lids hide it,
    since that shows when the eye turns. `gaze` (3,): where it looks, a unit vector; y is up."""
    middle = points.mean(0)
    half = (LIGHT_PICTURE_PIXELS - 1) / 2
    lens = Camera(
        (0.0, 0.0, 0.0),
        LIGHT_PICTURE_PIXELS * LIGHT_DISTANCE / LIGHT_PICTURE_METRES,
        (half, half),
        (LIGHT_PICTURE_PIXELS, LIGHT_PICTURE_PIXELS),
    )
    near = surface.triangles[
        (np.linalg.norm(surface.vertices - middle, axis=1) < LIGHT_PICTURE_METRES)[surface.triangles].all(1)
    ]
    total = np.zeros(len(points))
    normals = points - middle
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    for direction in _sky(gaze):
        camera = lens.aimed((middle + LIGHT_DISTANCE * direction).tolist(), middle.tolist())
        depth = depth_map(camera.project(surface.vertices), near, camera.size, perspective=True)
        depth = np.where(np.isfinite(depth), depth, 2 * LIGHT_DISTANCE).astype(np.float32)
        pixels = camera.project(points)
        lit = pixels[:, 2] <= bilinear(depth[..., None], pixels)[:, 0] + OCCLUSION_TOLERANCE_METRES
        total += lit * np.maximum(normals @ direction, 0) * (direction[1] + LEVEL_LIGHT_SHARE)
    seen = total > MIN_SEEN_LIGHT_SHARE * total.max()
    if not seen.any():
        return np.ones(len(points), np.float32)
    shade = MIN_LIGHT_SHARE + (1 - MIN_LIGHT_SHARE) * total / total.max()
    out = np.minimum(shade / shade[seen].mean(), 1)
    known = np.flatnonzero(seen)[::SEEN_POINT_STEP]
    away, nearest = cKDTree(points[known]).query(
        points[~seen], distance_upper_bound=SHADOW_END_LENGTHS * HIDDEN_SHADOW_FADE_METRES
    )
    taken = np.append(1 - out[known], 0)[nearest]
    out[~seen] = 1 - taken * np.exp(-away / HIDDEN_SHADOW_FADE_METRES)
    return np.asarray(out, np.float32)


def lash_shadow(
    points: NDArray[np.float64], rim: NDArray[np.float64], gaze: NDArray[np.float64]
) -> NDArray[np.float32]:
    """(N,) what an eyeball's colours at `points` (N, 3) are multiplied by for the lashes of the upper lid, which an
    avatar does not have: least right beneath that lid. It ends softly where the lid hides it, since that shows when the
    eye turns. `rim` (R, 3): the loop in which the lids end; `gaze` (3,): where the eye looks; y is up."""
    aside = np.cross([0.0, 1.0, 0.0], gaze)
    aside /= np.linalg.norm(aside)
    axes = np.stack([aside, np.cross(gaze, aside)], 1)
    middle = points.mean(0)
    seen, loop = (points - middle) @ axes, (rim - middle) @ axes
    ends = loop[[np.argmin(loop[:, 0]), np.argmax(loop[:, 0])]]
    share = np.arange(SHADOW_RIM_STEPS) / SHADOW_RIM_STEPS
    line = (loop[:, None] + share[:, None] * (np.roll(loop, -1, 0) - loop)[:, None]).reshape(-1, 2)
    upper = line[line[:, 1] >= np.interp(line[:, 0], ends[:, 0], ends[:, 1])]
    away = cKDTree(upper).query(seen, distance_upper_bound=SHADOW_END_LENGTHS * LASH_SHADOW_METRES)[0]
    ahead = (points - middle) @ gaze > 0
    return np.asarray(np.where(ahead, 1 - LASH_SHADOW_SHARE * np.exp(-away / LASH_SHADOW_METRES), 1), np.float32)


def _sky(gaze: NDArray[np.float64]) -> NDArray[np.float64]:
    """(L, 3) unit vectors of the half of the sphere about where a face looks, those from below left out."""
    k = np.arange(2 * LIGHT_DIRECTION_COUNT) + 0.5
    height = 1 - k / LIGHT_DIRECTION_COUNT
    turn = np.pi * (1 + np.sqrt(5)) * k
    level = np.sqrt(np.maximum(1 - height**2, 0))
    around = np.stack([level * np.cos(turn), height, level * np.sin(turn)], 1)
    return np.asarray(around[(around @ gaze > 0.1) & (around[:, 1] > -0.2)])
