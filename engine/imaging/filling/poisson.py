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

POISSON_V_CYCLES = 2
"""V-cycles on the finest grid after the full multigrid start: under 1% of the largest boundary step is left."""
RELAXATION_SWEEPS = 1, 20
"""Of relaxation on a grid, and on the coarsest one, which they solve."""


def poisson_blend(
    source: NDArray[np.float32], target: NDArray[np.float32], mask: NDArray[np.bool_], cycles: int = POISSON_V_CYCLES
) -> NDArray[np.float32]:
    """`target` (H, W, C) with `source` cloned into `mask` (H, W): its gradients, the target's edge colours.

    float32 in any unit, not clipped. Outside the mask the target is unchanged.
    """
    cloned = source + membrane(target - source, mask, cycles)
    return np.where(mask[..., None], cloned, target).astype(np.float32)


def membrane(
    boundary_difference: NDArray[np.float32],
    mask: NDArray[np.bool_],
    cycles: int = POISSON_V_CYCLES,
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
def _discretise(distance, values, step, grid, links, inverse, right):  # type: ignore[no-untyped-def]
    """The grid of every `step`-th pixel: which links lead to unknown pixels, the inverse of the diagonal (0
    where nothing is to be found) and what the edges' values (H, W, C) contribute. Whether there is anything to find."""
    begin, rows, columns = grid[0], grid[1], grid[2]
    channels = right.shape[1]
    found = False
    for y in range(1, rows - 1):
        for x in range(1, columns - 1):
            i = begin + y * columns + x
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
                        right[i, c] += weight * values[ey, ex, c]
                elif away < 0 and -away <= step:
                    continue
                else:
                    links[i, k] = 1
                    diagonal += 1
            if diagonal > 0:
                inverse[i], found = 1 / diagonal, True
    return found


@njit(fastmath=True, nogil=True)
def _find_runs(inverse, grid, runs, count):  # type: ignore[no-untyped-def]
    """Write to `runs`, from `count` on, row, first column and the column after the last of each stretch of the grid where
    there is something to find. The count afterwards."""
    begin, rows, columns = grid[0], grid[1], grid[2]
    for y in range(1, rows - 1):
        for x in range(1, columns - 1):
            i = begin + y * columns + x
            if inverse[i] == 0:
                continue
            if inverse[i - 1] == 0:
                runs[count, 0], runs[count, 1] = y, x
                count += 1
            runs[count - 1, 2] = x + 1
    return count


@njit(fastmath=True, nogil=True)
def _relax(u, right, links, inverse, runs, grid, sweeps):  # type: ignore[no-untyped-def]
    """Red-black Gauss-Seidel in place."""
    columns = grid[2]
    for half in range(2 * sweeps):
        for run in range(grid[3], grid[4]):
            y, first, end = runs[run, 0], runs[run, 1], runs[run, 2]
            row = grid[0] + y * columns
            for i in range(row + first + (first + 1 + y + half) % 2, row + end, 2):
                scale = inverse[i]
                a, b, c, d = links[i, 0], links[i, 1], links[i, 2], links[i, 3]
                for k in range(u.shape[1]):
                    total = a * u[i - columns, k] + b * u[i + columns, k] + c * u[i - 1, k] + d * u[i + 1, k]
                    u[i, k] = (right[i, k] + total) * scale


@njit(fastmath=True, nogil=True)
def _restrict_residual(u, right, links, inverse, runs, residual, grid, coarse):  # type: ignore[no-untyped-def]
    """The coarse grid's right side: the residual, fully weighted (4 fine pixels stand in a coarse one)."""
    columns = grid[2]
    for run in range(grid[3], grid[4]):
        row = grid[0] + runs[run, 0] * columns
        for i in range(row + runs[run, 1], row + runs[run, 2]):
            scale = inverse[i]
            a, b, c, d = links[i, 0], links[i, 1], links[i, 2], links[i, 3]
            for k in range(u.shape[1]):
                total = a * u[i - columns, k] + b * u[i + columns, k] + c * u[i - 1, k] + d * u[i + 1, k]
                residual[i, k] = right[i, k] + total - u[i, k] / scale
    for run in range(coarse[3], coarse[4]):
        y, first, end = runs[run, 0], runs[run, 1], runs[run, 2]
        into, fine = coarse[0] + y * coarse[2], grid[0] + (2 * y - 1) * columns - 1
        for x in range(first, end):
            i = fine + 2 * x
            for k in range(u.shape[1]):
                sides = residual[i - columns, k] + residual[i + columns, k] + residual[i - 1, k] + residual[i + 1, k]
                corners = residual[i - columns - 1, k] + residual[i - columns + 1, k]
                corners += residual[i + columns - 1, k] + residual[i + columns + 1, k]
                right[into + x, k] = residual[i, k] + sides / 2 + corners / 4


@njit(fastmath=True, nogil=True)
def _add_interpolated(u, runs, grid, coarse):  # type: ignore[no-untyped-def]
    """Add the coarse grid's correction, bilinearly; outside the mask it is 0."""
    for run in range(grid[3], grid[4]):
        y, first, end = runs[run, 0], runs[run, 1], runs[run, 2]
        row = grid[0] + y * grid[2]
        near = coarse[0] + (y + 1) // 2 * coarse[2]
        next_ = near + (y + 1) % 2 * coarse[2]
        for x in range(first, end):
            cx = (x + 1) // 2
            nx = cx + (x + 1) % 2
            for k in range(u.shape[1]):
                total = u[near + cx, k] + u[next_ + cx, k] + u[near + nx, k] + u[next_ + nx, k]
                u[row + x, k] += np.float32(0.25) * total


@njit(fastmath=True, nogil=True)
def _start_from(u, right, inverse, runs, grid, coarse):  # type: ignore[no-untyped-def]
    """A first guess from the coarse solution: the mean of the coarse pixels around that lie in the mask,
    or what the edge alone says where there are none."""
    for run in range(grid[3], grid[4]):
        y, first, end = runs[run, 0], runs[run, 1], runs[run, 2]
        row = grid[0] + y * grid[2]
        near = coarse[0] + (y + 1) // 2 * coarse[2]
        next_ = near + (y + 1) % 2 * coarse[2]
        for x in range(first, end):
            cx = (x + 1) // 2
            nx = cx + (x + 1) % 2
            a, b, c, d = near + cx, next_ + cx, near + nx, next_ + nx  # 0 where nothing is to be found
            count = (inverse[a] != 0) + (inverse[b] != 0) + (inverse[c] != 0) + (inverse[d] != 0)
            for k in range(u.shape[1]):
                if count == 0:
                    u[row + x, k] = right[row + x, k] * inverse[row + x]
                else:
                    u[row + x, k] = (u[a, k] + u[b, k] + u[c, k] + u[d, k]) / count


@njit(fastmath=True, nogil=True)
def _full_multigrid(u, own, right, links, inverse, residual, runs, grids, cycles, sweeps):  # type: ignore[no-untyped-def]
    """Fill `u` (N, C) from the coarsest grid to the finest, with V-cycles on each; `sweeps` on a grid, and on the coarsest."""
    last = len(grids) - 1
    some, many = sweeps
    _relax(u, own, links, inverse, runs, grids[last], many)
    for first in range(last, -1, -1):
        if first < last:
            _start_from(u, own, inverse, runs, grids[first], grids[first + 1])
        for i in range(grids[first, 0], grids[first, 0] + grids[first, 1] * grids[first, 2]):
            for k in range(u.shape[1]):
                right[i, k] = own[i, k]
        for _ in range(cycles if first == 0 else 1):
            for level in range(first, last):
                _relax(u, right, links, inverse, runs, grids[level], some)
                _restrict_residual(u, right, links, inverse, runs, residual, grids[level], grids[level + 1])
                u[grids[level + 1, 0] : grids[level + 1, 0] + grids[level + 1, 1] * grids[level + 1, 2]] = 0
            _relax(u, right, links, inverse, runs, grids[last], many)
            for level in range(last - 1, first - 1, -1):
                _add_interpolated(u, runs, grids[level], grids[level + 1])
                _relax(u, right, links, inverse, runs, grids[level], some)


def _solve(
    values: NDArray[np.float32], force: NDArray[np.float32], mask: NDArray[np.bool_], cycles: int
) -> NDArray[np.float32]:
    """The membrane (H, W, C) in `mask` (H, W), 0 elsewhere. The grids lie one after another in each array, each in a frame
    one pixel wide: `grids` (L, 5) says of each its first pixel, its rows and columns, its first run and the one after its
    last."""
    height, width, channels = values.shape
    steps = [2**level for level in range(max((min(height, width) - 1).bit_length(), 1))]
    sizes = np.array([((height + step - 1) // step + 2, (width + step - 1) // step + 2) for step in steps])
    pixels = sizes.prod(1)
    grids = np.zeros((len(steps), 5), np.int64)
    grids[:, 0], grids[:, 1:3] = np.cumsum(pixels) - pixels, sizes
    u, own, right, residual = (np.zeros((pixels.sum(), channels), np.float32) for _ in range(4))
    links, inverse = np.zeros((pixels.sum(), 4), np.float32), np.zeros(pixels.sum(), np.float32)
    runs = np.empty((int((sizes[:, 0] * (sizes[:, 1] // 2)).sum()), 3), np.int32)
    distance = _edge_distances(mask)
    finest = own[: pixels[0]].reshape(*sizes[0], channels)
    finest[1:-1, 1:-1] = force  # the coarse grids learn of it by the residual
    count = 0
    for level, (step, grid) in enumerate(zip(steps, grids, strict=True)):
        if not _discretise(distance, values, step, grid, links, inverse, own) and level > 0:
            grids = grids[:level]
            break
        grid[3], count = count, _find_runs(inverse, grid, runs, count)
        grid[4] = count
    _full_multigrid(u, own, right, links, inverse, residual, runs, grids, cycles, RELAXATION_SWEEPS)
    return u[: pixels[0]].reshape(*sizes[0], channels)[1:-1, 1:-1]
