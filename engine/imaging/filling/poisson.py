"""Seamless cloning: Laplace's equation inside a mask, fast enough to be solved for every frame.

Pérez, Gangnet, Blake, "Poisson image editing", SIGGRAPH 2003: what is pasted keeps its gradients if the membrane that
interpolates the differences along the mask's edge is added to it. The membrane is found by full multigrid. The masks are
irregular, so a coarse grid must know where the fine mask ends: each link of a coarse pixel that runs into the mask's edge
ends there, at its true distance (Shortley and Weller 1938). So every grid is an accurate picture of the same problem.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.masks.mask_pieces import bounding_box

V_CYCLES = 2
"""V-cycles on the finest grid after the full multigrid start: under 1% of the largest boundary step is left."""


def poisson_blend(
    source: NDArray[np.float32], target: NDArray[np.float32], mask: NDArray[np.bool_], cycles: int = V_CYCLES
) -> NDArray[np.float32]:
    """`target` (H, W, C) with `source` cloned into `mask` (H, W): its gradients, the target's edge colours.

    float32 in any unit, not clipped. Outside the mask the target is unchanged.
    """
    cloned = source + membrane(target - source, mask, cycles)
    return np.where(mask[..., None], cloned, target).astype(np.float32)


def membrane(
    boundary_difference: NDArray[np.float32],
    mask: NDArray[np.bool_],
    cycles: int = V_CYCLES,
    divergence: NDArray[np.float32] | None = None,
) -> NDArray[np.float32]:
    """Laplace interpolation into `mask` (H, W) of the values (H, W, C) found just outside it; 0 elsewhere.

    Solves sum over the four neighbours q of p of (u_q - u_p) = `divergence` (H, W, C), or 0, for p in the mask,
    u being given outside.
    Where the mask meets the array's border the membrane is free there. A part of the mask that nothing
    outside holds is left at 0.
    """
    values = np.ascontiguousarray(boundary_difference, np.float32)
    if not mask.any():
        return np.zeros_like(values)
    inside = bounding_box(mask, margin=1)
    inner = np.ascontiguousarray(mask[inside])
    result = np.zeros_like(values)
    force = np.zeros_like(values) if divergence is None else -divergence
    result[inside] = _solve(
        np.ascontiguousarray(values[inside]), np.ascontiguousarray(force[inside], np.float32), inner, cycles
    )
    return result


@njit(fastmath=True, nogil=True)
def _edge_distances(mask):  # type: ignore[no-untyped-def]
    """How far each masked pixel is from the first pixel outside the mask, (H + 2, W + 2, 4) int32 in the
    directions up, down, left, right, in a frame one pixel wide; negative to the array's border instead."""
    height, width = mask.shape
    distance = np.zeros((height + 2, width + 2, 4), np.int32)
    for y in range(height):
        for x in range(width):
            if mask[y, x]:
                above, before = distance[y, x + 1, 0], distance[y + 1, x, 2]
                at_top, at_left = y == 0, x == 0
                distance[y + 1, x + 1, 0] = -1 if at_top else (above - 1 if above < 0 else above + 1)
                distance[y + 1, x + 1, 2] = -1 if at_left else (before - 1 if before < 0 else before + 1)
    for y in range(height - 1, -1, -1):
        for x in range(width - 1, -1, -1):
            if mask[y, x]:
                below, after = distance[y + 2, x + 1, 1], distance[y + 1, x + 2, 3]
                at_bottom, at_right = y == height - 1, x == width - 1
                distance[y + 1, x + 1, 1] = -1 if at_bottom else (below - 1 if below < 0 else below + 1)
                distance[y + 1, x + 1, 3] = -1 if at_right else (after - 1 if after < 0 else after + 1)
    return distance


@njit(fastmath=True, nogil=True)
def _discretise(distance, values, step, links, inverse, right):  # type: ignore[no-untyped-def]
    """The grid of every `step`-th pixel: which links lead to unknown pixels, the inverse of the diagonal (0
    where nothing is to be found) and what the edges' values (H, W, C) contribute. Whether there is anything to find."""
    height, width = inverse.shape
    channels = right.shape[2]
    found = False
    for y in range(1, height - 1):
        for x in range(1, width - 1):
            fy, fx = (y - 1) * step + 1, (x - 1) * step + 1
            if distance[fy, fx, 0] == 0:
                continue
            diagonal = np.float32(0)
            for k in range(4):
                away = distance[fy, fx, k]
                if 0 < away <= step:  # the edge is nearer than the next grid pixel, or just there
                    weight = np.float32(step) / np.float32(away)
                    diagonal += weight
                    ey = fy - 1 + (away if k == 1 else -away if k == 0 else 0)
                    ex = fx - 1 + (away if k == 3 else -away if k == 2 else 0)
                    for c in range(channels):
                        right[y, x, c] += weight * values[ey, ex, c]
                elif away < 0 and -away <= step:
                    continue
                else:
                    links[y, x, k] = 1
                    diagonal += 1
            if diagonal > 0:
                inverse[y, x], found = 1 / diagonal, True
    return found


@njit(fastmath=True, nogil=True)
def _runs(inverse):  # type: ignore[no-untyped-def]
    """(R, 3) int32: row, first column and the column after the last of each stretch where there is something to find."""
    height, width = inverse.shape
    found = np.empty((height * (width // 2 + 1), 3), np.int32)
    count = 0
    for y in range(1, height - 1):
        for x in range(1, width - 1):
            if inverse[y, x] == 0:
                continue
            if inverse[y, x - 1] == 0:
                found[count, 0], found[count, 1] = y, x
                count += 1
            found[count - 1, 2] = x + 1
    return found[:count].copy()


@njit(fastmath=True, nogil=True)
def _relax(u, right, links, inverse, runs, sweeps):  # type: ignore[no-untyped-def]
    """Red-black Gauss-Seidel in place."""
    for half in range(2 * sweeps):
        for run in range(len(runs)):
            y, first, end = runs[run]
            for x in range(first + (first + 1 + y + half) % 2, end, 2):
                scale = inverse[y, x]
                a, b, c, d = links[y, x, 0], links[y, x, 1], links[y, x, 2], links[y, x, 3]
                for k in range(u.shape[2]):
                    total = a * u[y - 1, x, k] + b * u[y + 1, x, k] + c * u[y, x - 1, k] + d * u[y, x + 1, k]
                    u[y, x, k] = (right[y, x, k] + total) * scale


@njit(fastmath=True, nogil=True)
def _restrict_residual(u, right, links, inverse, runs, residual, coarse, coarse_runs):  # type: ignore[no-untyped-def]
    """The coarse grid's right side: the residual, fully weighted (4 fine pixels stand in a coarse one)."""
    for run in range(len(runs)):
        y, first, end = runs[run]
        for x in range(first, end):
            scale = inverse[y, x]
            a, b, c, d = links[y, x, 0], links[y, x, 1], links[y, x, 2], links[y, x, 3]
            for k in range(u.shape[2]):
                total = a * u[y - 1, x, k] + b * u[y + 1, x, k] + c * u[y, x - 1, k] + d * u[y, x + 1, k]
                residual[y, x, k] = right[y, x, k] + total - u[y, x, k] / scale
    for run in range(len(coarse_runs)):
        y, first, end = coarse_runs[run]
        for x in range(first, end):
            fy, fx = 2 * y - 1, 2 * x - 1
            for k in range(u.shape[2]):
                sides = residual[fy - 1, fx, k] + residual[fy + 1, fx, k]
                sides += residual[fy, fx - 1, k] + residual[fy, fx + 1, k]
                corners = residual[fy - 1, fx - 1, k] + residual[fy - 1, fx + 1, k]
                corners += residual[fy + 1, fx - 1, k] + residual[fy + 1, fx + 1, k]
                coarse[y, x, k] = residual[fy, fx, k] + sides / 2 + corners / 4


@njit(fastmath=True, nogil=True)
def _add_interpolated(coarse, u, runs):  # type: ignore[no-untyped-def]
    """Add the coarse grid's correction, bilinearly; outside the mask it is 0."""
    for run in range(len(runs)):
        y, first, end = runs[run]
        cy = (y + 1) // 2
        ny = cy + (y + 1) % 2
        for x in range(first, end):
            cx = (x + 1) // 2
            nx = cx + (x + 1) % 2
            for k in range(u.shape[2]):
                total = coarse[cy, cx, k] + coarse[ny, cx, k] + coarse[cy, nx, k] + coarse[ny, nx, k]
                u[y, x, k] += np.float32(0.25) * total


@njit(fastmath=True, nogil=True)
def _start_from(coarse, coarse_inverse, u, right, inverse, runs):  # type: ignore[no-untyped-def]
    """A first guess from the coarse solution: the mean of the coarse pixels around that lie in the mask,
    or what the edge alone says where there are none."""
    for run in range(len(runs)):
        y, first, end = runs[run]
        cy = (y + 1) // 2
        ny = cy + (y + 1) % 2
        for x in range(first, end):
            cx = (x + 1) // 2
            nx = cx + (x + 1) % 2
            a, b = coarse_inverse[cy, cx] != 0, coarse_inverse[ny, cx] != 0
            c, d = coarse_inverse[cy, nx] != 0, coarse_inverse[ny, nx] != 0
            count = a + b + c + d
            for k in range(u.shape[2]):
                if count == 0:
                    u[y, x, k] = right[y, x, k] * inverse[y, x]
                else:
                    total = (
                        a * coarse[cy, cx, k] + b * coarse[ny, cx, k] + c * coarse[cy, nx, k] + d * coarse[ny, nx, k]
                    )
                    u[y, x, k] = total / count


@njit(fastmath=True, nogil=True)
def _solve(values, force, mask, cycles):  # type: ignore[no-untyped-def]
    height, width, channels = values.shape
    distance = _edge_distances(mask)
    u = [np.zeros((height + 2, width + 2, channels), np.float32)]
    own = [np.zeros_like(u[0])]
    links = [np.zeros((height + 2, width + 2, 4), np.float32)]
    inverse = [np.zeros((height + 2, width + 2), np.float32)]
    _discretise(distance, values, 1, links[0], inverse[0], own[0])
    own[0][1:-1, 1:-1] += force  # the coarse grids learn of it by the residual
    step = 1
    while (min(height, width) - 1) // (2 * step) >= 1:
        step *= 2
        rows, columns = (height + step - 1) // step + 2, (width + step - 1) // step + 2
        coarser = np.zeros((rows, columns), np.float32)
        coarser_links = np.zeros((rows, columns, 4), np.float32)
        coarser_own = np.zeros((rows, columns, channels), np.float32)
        if not _discretise(distance, values, step, coarser_links, coarser, coarser_own):
            break
        u.append(np.zeros((rows, columns, channels), np.float32))
        own.append(coarser_own)
        links.append(coarser_links)
        inverse.append(coarser)
    runs = [_runs(level) for level in inverse]
    right = [np.zeros_like(level) for level in own]
    residual = [np.zeros_like(level) for level in own]
    last = len(u) - 1
    _relax(u[last], own[last], links[last], inverse[last], runs[last], 20)
    for first in range(last, -1, -1):
        if first < last:
            _start_from(u[first + 1], inverse[first + 1], u[first], own[first], inverse[first], runs[first])
        right[first][:] = own[first]
        for _ in range(cycles if first == 0 else 1):
            for level in range(first, last):
                if level > first:
                    u[level][:] = 0
                _relax(u[level], right[level], links[level], inverse[level], runs[level], 1)
                _restrict_residual(
                    u[level],
                    right[level],
                    links[level],
                    inverse[level],
                    runs[level],
                    residual[level],
                    right[level + 1],
                    runs[level + 1],
                )
            if last > first:
                u[last][:] = 0
            _relax(u[last], right[last], links[last], inverse[last], runs[last], 20)
            for level in range(last - 1, first - 1, -1):
                _add_interpolated(u[level + 1], u[level], runs[level])
                _relax(u[level], right[level], links[level], inverse[level], runs[level], 1)
    return u[0][1:-1, 1:-1].copy()
