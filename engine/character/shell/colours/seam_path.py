"""The cheapest path along a strip: in each row a column at which one thing ends and another begins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def cheapest_path(cost: NDArray[np.floating], step: int, step_cost: float) -> NDArray[np.intp]:
    """The columns (R,) of the path down `cost` (R, C) of the least sum, by dynamic programming. From one row to the next it moves by at
    most `step` columns, each of which costs `step_cost`."""
    rows, columns = cost.shape
    moves = np.arange(-step, step + 1)
    from_which = np.zeros((rows, columns), np.intp)
    total = cost[0].astype(np.float64)
    for row in range(1, rows):
        padded = np.pad(total, step, constant_values=np.inf)
        before = np.stack([padded[step + move : step + move + columns] + step_cost * abs(move) for move in moves])
        best = before.argmin(0)
        from_which[row] = np.arange(columns) + moves[best]
        total = before[best, np.arange(columns)] + cost[row]
    path = np.empty(rows, np.intp)
    path[-1] = int(total.argmin())
    for row in range(rows - 1, 0, -1):
        path[row - 1] = from_which[row, path[row]]
    return path


def sides_cost(
    inside: NDArray[np.floating], outside: NDArray[np.floating], crossing: NDArray[np.floating]
) -> NDArray[np.float64]:
    """What it costs (R, C + 1) to end before each column: the sum of `inside` (R, C) before it, of `outside` (R, C) from it on, and of
    `crossing` (R, C) at it; at the last there is nothing to cross."""
    none = np.zeros((len(inside), 1))
    before = np.concatenate([none, np.cumsum(inside, 1)], 1)
    after = np.concatenate([np.cumsum(outside[:, ::-1], 1)[:, ::-1], none], 1)
    return np.asarray(before + after + np.concatenate([crossing, none], 1), np.float64)
