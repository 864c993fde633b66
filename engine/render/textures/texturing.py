"""Colours of a drawn character: one look-up in a pixel that one smooth piece of surface fills, several where the
outline runs, or where two surfaces meet."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.render.textures.mipmap import look_up

MAX_FOOTPRINT_RATIO = 4.0
"""Two pixels side by side show one surface where they are apart on the texture by no more than this many times what a pixel
covers of it, and `TOLERANCE_TEXELS`."""
TOLERANCE_TEXELS = 2.0
"""Texels by which pixels of one surface may be further apart than `MAX_FOOTPRINT_RATIO` allows."""


class TexturedSurface(NamedTuple):
    """A posed surface with its texture, as compiled code takes it."""

    corners: np.ndarray
    """(V, 5 or 6) of `corner_table`."""
    faces: np.ndarray
    """(T, 3) int32."""
    spread: np.ndarray
    """(T,) the area of each triangle on the texture, texels."""
    texels: np.ndarray
    """(N,) uint32, all levels of the texture as `engine.render.textures.mipmap.Mipmap` has them."""
    starts: np.ndarray
    """(L,) int64, where each level begins among them."""
    sizes: np.ndarray
    """(L, 2) int64, each level's height and width."""


class PictureWindow(NamedTuple):
    """A part of a picture, which begins at column `left` and row `top` of the whole."""

    rgb: np.ndarray
    """(H, W, 3) uint8, of the whole picture."""
    alpha: np.ndarray
    """(H, W) float32, of the whole picture."""
    left: int
    top: int


def corner_table(
    points: NDArray[np.float32], uv: NDArray[np.float32], shade: NDArray[np.float32] | None
) -> NDArray[np.float32]:
    """(V, 5) or, with `shade` (V,), (V, 6) what a triangle needs of its corners. That is x and y in pixels, one over
    the distance, and u, v and the shade over the distance: these are linear on the screen. `points` (V, 3) as
    `Camera.project` gives them."""
    table = np.empty((len(points), 5 if shade is None else 6), np.float32)
    table[:, :2] = points[:, :2]
    np.divide(1, points[:, 2], out=table[:, 2], where=points[:, 2] > 0)
    np.multiply(uv, table[:, 2:3], out=table[:, 3:5])
    if shade is not None:
        np.multiply(shade, table[:, 2], out=table[:, 5])
    return table


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy")
def colour_inside(surface: TexturedSurface, ids: np.ndarray, marks: np.ndarray, window: PictureWindow) -> None:
    """Colour the picture and set its alpha where the centre of a pixel of the window shows a triangle (`ids` (h, w)) and is
    not marked (`marks` (h, w)). Pixels are then marked where the texture jumps to the next one: another piece of surface
    begins there.
    """
    corners, faces, spread, texels, starts, sizes = surface
    rgb, alpha, left, top = window
    height, width = ids.shape
    high, wide = np.float32(sizes[0, 0]), np.float32(sizes[0, 1])
    half, one = np.float32(0.5), np.float32(1)
    shaded = corners.shape[1] > 5
    above = np.full(
        (width, 2), -1, np.float32
    )  # where the row above is on the texture, texels; -1 where it was left out
    for y in range(height):
        x, neighbour = 0, False
        left_u, left_v = np.float32(0), np.float32(0)
        while x < width:
            t = ids[y, x]
            if t < 0 or marks[y, x]:
                above[x, 0] = -1
                neighbour = False
                x += 1
                continue
            end = x + 1
            while end < width and ids[y, end] == t and not marks[y, end]:
                end += 1
            a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
            ax, ay = corners[a, 0] - np.float32(x), corners[a, 1] - np.float32(y)
            bx, by = corners[b, 0] - np.float32(x), corners[b, 1] - np.float32(y)
            cx, cy = corners[c, 0] - np.float32(x), corners[c, 1] - np.float32(y)
            wa, wb, wc = bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx
            da, db, dc = by - cy, cy - ay, ay - by
            footprint = spread[t] / max(abs(wa + wb + wc) * half, np.float32(1e-6))
            level = half * np.log2(footprint) if footprint > one else np.float32(0)
            limit = np.float32(MAX_FOOTPRINT_RATIO) * np.sqrt(footprint) + np.float32(TOLERANCE_TEXELS)
            w = wa * corners[a, 2] + wb * corners[b, 2] + wc * corners[c, 2]
            wu = wa * corners[a, 3] + wb * corners[b, 3] + wc * corners[c, 3]
            wv = wa * corners[a, 4] + wb * corners[b, 4] + wc * corners[c, 4]
            dw = da * corners[a, 2] + db * corners[b, 2] + dc * corners[c, 2]
            du = da * corners[a, 3] + db * corners[b, 3] + dc * corners[c, 3]
            dv = da * corners[a, 4] + db * corners[b, 4] + dc * corners[c, 4]
            ws, ds = np.float32(0), np.float32(0)
            if shaded:
                ws = wa * corners[a, 5] + wb * corners[b, 5] + wc * corners[c, 5]
                ds = da * corners[a, 5] + db * corners[b, 5] + dc * corners[c, 5]
            first = x
            while x < end:
                total = one / w
                u, v = wu * total, wv * total
                red, green, blue = look_up(texels, starts, sizes, u, v, level)
                if shaded:
                    dark = ws * total
                    red, green, blue = dark * red, dark * green, dark * blue
                i, j = top + y, left + x
                rgb[i, j, 0], rgb[i, j, 1], rgb[i, j, 2] = int(red + half), int(green + half), int(blue + half)
                alpha[i, j] = one
                u, v = u * wide, v * high
                if x == first and neighbour and abs(u - left_u) + abs(v - left_v) > limit:
                    marks[y, x] = marks[y, x - 1] = True
                if above[x, 0] >= 0 and abs(u - above[x, 0]) + abs(v - above[x, 1]) > limit:
                    marks[y, x] = marks[y - 1, x] = True
                above[x, 0], above[x, 1] = u, v
                left_u, left_v = u, v
                w, wu, wv, ws = w + dw, wu + du, wv + dv, ws + ds
                x += 1
            neighbour = True


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy")
def _colour(surface: TexturedSurface, t: int, x: np.float32, y: np.float32) -> tuple:
    """The texture where triangle `t` covers (x, y), as sharp as a pixel can show it."""
    corners, faces, spread, texels, starts, sizes = surface
    a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
    ax, ay = corners[a, 0] - x, corners[a, 1] - y
    bx, by = corners[b, 0] - x, corners[b, 1] - y
    cx, cy = corners[c, 0] - x, corners[c, 1] - y
    wa, wb, wc = bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx
    half, tiny = np.float32(0.5), np.float32(1e-6)
    level = half * np.log2((spread[t] + tiny) / (abs(wa + wb + wc) * half + tiny))
    total = np.float32(1) / (wa * corners[a, 2] + wb * corners[b, 2] + wc * corners[c, 2])
    u = (wa * corners[a, 3] + wb * corners[b, 3] + wc * corners[c, 3]) * total
    v = (wa * corners[a, 4] + wb * corners[b, 4] + wc * corners[c, 4]) * total
    red, green, blue = look_up(texels, starts, sizes, u, v, level)
    if corners.shape[1] > 5:
        dark = (wa * corners[a, 5] + wb * corners[b, 5] + wc * corners[c, 5]) * total
        return dark * red, dark * green, dark * blue
    return red, green, blue


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy")
def colour_samples(
    surface: TexturedSurface,
    ids: np.ndarray,
    places: np.ndarray,
    offsets: np.ndarray,
    alone: bool,
    window: PictureWindow,
) -> None:
    """Each of the pixels that were chosen (`places` (N, 2) of `multisampling.PixelSelection`) gets the mean of its samples,
    `ids` (N, S) and `offsets` (S, 2) in pixels, over what the picture holds (or `alone`). The samples of a pixel that one
    triangle covers are coloured together, in their middle."""
    rgb, alpha, left, top = window
    samples = len(offsets)
    full, half = np.float32(samples), np.float32(0.5)
    found = np.empty((samples, 2), np.int32)  # the triangles in a pixel: which, how often
    middle = np.empty((samples, 2), np.float32)  # sums of their samples' places
    for n in range(len(places)):
        y, x = places[n, 0], places[n, 1]
        row, column = top + y, left + x
        kinds, covered = 0, 0
        for s in range(samples):
            t = ids[n, s]
            if t < 0:
                continue
            k = kinds - 1
            while k >= 0 and found[k, 0] != t:
                k -= 1
            if k < 0:
                k = kinds
                kinds += 1
                found[k, 0], found[k, 1], middle[k, 0], middle[k, 1] = t, 0, 0, 0
            found[k, 1] += 1
            middle[k, 0] += offsets[s, 0]
            middle[k, 1] += offsets[s, 1]
            covered += 1
        alpha[row, column] = np.float32(covered) / full
        if covered == 0:
            continue
        red, green, blue = np.float32(0), np.float32(0), np.float32(0)
        for k in range(kinds):
            count = np.float32(found[k, 1])
            px, py = np.float32(x) + middle[k, 0] / count, np.float32(y) + middle[k, 1] / count
            r, g, b = _colour(surface, found[k, 0], px, py)
            red, green, blue = red + count * r, green + count * g, blue + count * b
        if alone:
            rgb[row, column, 0] = int(red / covered + half)
            rgb[row, column, 1] = int(green / covered + half)
            rgb[row, column, 2] = int(blue / covered + half)
        else:
            rest = np.float32(1) - alpha[row, column]
            rgb[row, column, 0] = int(red / full + rest * rgb[row, column, 0] + half)
            rgb[row, column, 1] = int(green / full + rest * rgb[row, column, 1] + half)
            rgb[row, column, 2] = int(blue / full + rest * rgb[row, column, 2] + half)
