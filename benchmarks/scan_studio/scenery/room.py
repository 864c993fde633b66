"""A furnished room, 6.4 metres wide and as deep: few flat panels, each with a texture of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.scenery import room_textures
from benchmarks.scan_studio.scenery.room_textures import Texture

ROOM_TEXELS_PER_METRE = 256
"""Of the room's texture: 4 millimetres each."""
WALL_DISTANCE_METRES = 3.2
"""Metres from the middle of the room to its walls."""
CEILING_HEIGHT_METRES = 2.8
"""Metres from the floor up."""
TILE_SIDE_METRES = 0.2
"""Metres, at most, of the side of a panel's tiles: a tile is drawn with one level of detail."""
PANEL_GUTTER_TEXELS = 4
"""Texels around each panel on the room's texture, which continue it."""
WALL_COLOURS = ((206, 198, 184), (176, 190, 196), (202, 184, 170), (190, 196, 176))
"""sRGB of the four walls."""
FLOOR_CONTACT_SHADE_SHARE = 0.4
"""Share of the floor's light that the feet take."""
CONTACT_METRES = 0.28
"""How far around."""

Paint = Callable[[tuple[int, int], np.random.Generator], Texture]
"""What a surface of a size (height, width) in texels looks like."""


@dataclass(frozen=True)
class Panel:
    """A rectangle, as seen by who faces it."""

    corner: tuple[float, float, float]
    """The upper left one, metres."""
    right: tuple[float, float, float]
    """The edge from there to the right, metres."""
    down: tuple[float, float, float]
    """The edge from there down, metres."""
    paint: Paint
    light: float = 1.0
    """By what the room's light multiplies the paint."""


@dataclass(frozen=True)
class Room:
    """A textured mesh around the origin, with the floor at y = 0."""

    vertices: NDArray[np.float64]
    """(V, 3) metres."""
    triangles: NDArray[np.int32]
    """(T, 3)."""
    uv: NDArray[np.float32]
    """(V, 2) places on the texture, in [0, 1], (0, 0) its top left corner."""
    texture: NDArray[np.uint8]
    """(H, W, 3) sRGB."""
    shade: NDArray[np.float32]
    """(V,) by what the light multiplies the texture."""


def furnished_room(seed: int, texels_per_metre: int = ROOM_TEXELS_PER_METRE) -> Room:
    """The room with its furniture; the seed decides what hangs on its walls."""
    random = np.random.default_rng(seed)
    return _assembled([*_shell(), *_rug(), *_posters(random), *_furniture()], texels_per_metre, random)


def _shell() -> list[Panel]:
    side, low = 2 * WALL_DISTANCE_METRES, -WALL_DISTANCE_METRES
    walls = [
        ((low, CEILING_HEIGHT_METRES, low), (side, 0, 0)),
        ((WALL_DISTANCE_METRES, CEILING_HEIGHT_METRES, low), (0, 0, side)),
        ((WALL_DISTANCE_METRES, CEILING_HEIGHT_METRES, WALL_DISTANCE_METRES), (-side, 0, 0)),
        ((low, CEILING_HEIGHT_METRES, WALL_DISTANCE_METRES), (0, 0, -side)),
    ]
    lights = (0.95, 0.85, 0.9, 0.8)
    found = [
        Panel(corner, right, (0, -CEILING_HEIGHT_METRES, 0), partial(room_textures.plaster, colour=colour), light)
        for (corner, right), colour, light in zip(walls, WALL_COLOURS, lights, strict=True)
    ]
    board = partial(room_textures.wood, board=36)
    ceiling = partial(room_textures.plaster, colour=(222, 220, 214))
    return [
        *found,
        Panel((low, 0, low), (side, 0, 0), (0, 0, side), board),
        Panel((low, CEILING_HEIGHT_METRES, WALL_DISTANCE_METRES), (side, 0, 0), (0, 0, -side), ceiling, 0.85),
    ]


def _rug() -> list[Panel]:
    return [Panel((-1.3, 0.004, -1.1), (2.6, 0, 0), (0, 0, 2.2), room_textures.carpet)]


def _posters(random: np.random.Generator) -> list[Panel]:
    """Three or four on each wall, side by side, a little before it."""
    found = []
    for wall in range(4):
        turn = np.array([[0, -1], [1, 0]])
        turned = np.linalg.matrix_power(turn, wall)
        x = -WALL_DISTANCE_METRES + random.uniform(0.2, 0.5)
        while x < WALL_DISTANCE_METRES - 1.0:
            wide, high = random.uniform(0.6, 1.4), random.uniform(0.6, 1.3)
            wide = min(wide, WALL_DISTANCE_METRES - 0.1 - x)
            top = random.uniform(max(high + 0.2, 1.5), CEILING_HEIGHT_METRES - 0.15)
            across, along = turned @ [x, -WALL_DISTANCE_METRES + 0.01], turned @ [wide, 0.0]
            corner = (float(across[0]), float(top), float(across[1]))
            found.append(
                Panel(corner, (float(along[0]), 0.0, float(along[1])), (0, -high, 0), room_textures.poster, 0.95)
            )
            x += wide + random.uniform(0.15, 0.5)
    return found


def _furniture() -> list[Panel]:
    shelf = partial(room_textures.books, boards=4)
    plank = partial(room_textures.wood, board=30)
    sofa = partial(room_textures.fabric, colour=(96, 112, 128))
    chest = partial(room_textures.fabric, colour=(164, 92, 58))
    return [
        *_box((-2.6, 0, -3.19), (1.2, 1.6, 0.32), shelf, plank),
        *_box((1.0, 0, -3.19), (0.9, 1.2, 0.35), shelf, plank),
        *_box((2.45, 0, -1.2), (0.74, 0.72, 2.0), sofa, sofa),
        *_box((-3.19, 0, 0.2), (0.5, 0.75, 1.5), plank, plank),
        *_box((-0.6, 0, 2.6), (1.1, 0.5, 0.58), chest, chest),
        *_box((1.5, 0, 2.75), (0.8, 1.0, 0.4), shelf, plank),
    ]


def _box(low: tuple[float, float, float], size: tuple[float, float, float], front: Paint, rest: Paint) -> list[Panel]:
    """The four sides of a box and its top."""
    (x, y, z), (w, h, d) = low, size
    down = (0.0, -h, 0.0)
    return [
        Panel((x, y + h, z + d), (w, 0, 0), down, front, 0.95),
        Panel((x + w, y + h, z), (-w, 0, 0), down, front, 0.8),
        Panel((x + w, y + h, z + d), (0, 0, -d), down, rest, 0.85),
        Panel((x, y + h, z), (0, 0, d), down, rest, 0.75),
        Panel((x, y + h, z), (w, 0, 0), (0, 0, d), rest),
    ]


def _assembled(panels: list[Panel], texels_per_metre: int, random: np.random.Generator) -> Room:
    """All panels as one mesh with one texture, on which they lie in rows, the highest first."""
    sizes = [
        tuple(max(8, round(float(np.linalg.norm(edge)) * texels_per_metre)) for edge in (panel.down, panel.right))
        for panel in panels
    ]
    width = max(columns for _, columns in sizes) * 2 + 4 * PANEL_GUTTER_TEXELS
    places, x, y, deep = {}, 0, 0, 0
    for k in sorted(range(len(panels)), key=lambda k: -sizes[k][0]):
        rows, columns = sizes[k][0] + 2 * PANEL_GUTTER_TEXELS, sizes[k][1] + 2 * PANEL_GUTTER_TEXELS
        if x + columns > width:
            x, y, deep = 0, y + deep, 0
        places[k] = (x + PANEL_GUTTER_TEXELS, y + PANEL_GUTTER_TEXELS)
        x, deep = x + columns, max(deep, rows)
    height = y + deep
    texture = np.zeros((height, width, 3), np.uint8)
    vertices, triangles, uv, shade, count = [], [], [], [], 0
    for k, panel in enumerate(panels):
        (left, top), (rows, columns) = places[k], sizes[k]
        painted = np.clip(panel.paint((rows, columns), random) + 0.5, 0, 255).astype(np.uint8)
        padded = np.pad(
            painted,
            ((PANEL_GUTTER_TEXELS, PANEL_GUTTER_TEXELS), (PANEL_GUTTER_TEXELS, PANEL_GUTTER_TEXELS), (0, 0)),
            mode="edge",
        )
        texture[
            top - PANEL_GUTTER_TEXELS : top + rows + PANEL_GUTTER_TEXELS,
            left - PANEL_GUTTER_TEXELS : left + columns + PANEL_GUTTER_TEXELS,
        ] = padded
        points, faces, share = _tiles(panel)
        vertices.append(points)
        triangles.append(faces + count)
        uv.append((share * [columns, rows] + [left, top]) / [width, height])
        shade.append(panel.light * _contact(points))
        count += len(points)
    return Room(
        np.concatenate(vertices),
        np.concatenate(triangles).astype(np.int32),
        np.concatenate(uv).astype(np.float32),
        texture,
        np.concatenate(shade).astype(np.float32),
    )


def _tiles(panel: Panel) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    """Vertices, triangles and (V, 2) shares along the panel's right and down."""
    right, down = np.array(panel.right, np.float64), np.array(panel.down, np.float64)
    across, below = (max(1, int(np.ceil(np.linalg.norm(edge) / TILE_SIDE_METRES))) for edge in (right, down))
    u, v = np.meshgrid(np.linspace(0, 1, across + 1), np.linspace(0, 1, below + 1))
    share = np.stack([u.ravel(), v.ravel()], 1)
    number = np.arange(len(share)).reshape(below + 1, across + 1)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = np.concatenate([np.stack([a, d, c], -1).reshape(-1, 3), np.stack([a, c, b], -1).reshape(-1, 3)])
    return panel.corner + share[:, :1] * right + share[:, 1:] * down, faces, share


def _contact(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(V,) what the feet leave of the light that falls on the floor."""
    near = np.exp(-((points[:, 0] ** 2 + points[:, 2] ** 2) / CONTACT_METRES**2))
    return np.where(points[:, 1] < 0.1, 1 - FLOOR_CONTACT_SHADE_SHARE * near, 1.0)
