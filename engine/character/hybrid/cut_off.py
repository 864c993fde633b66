"""Limbs cut off the shell: what is shown of it, and closed within the trunk."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from engine.character.hybrid.limbs import Limbs
from engine.character.shell.template_mesh import TemplateMesh
from engine.geometry.mesh.adjacency import open_edges


def cut_off(mesh: TemplateMesh, limbs: Limbs) -> TemplateMesh:
    """The mesh of the limbs alone, closed within the trunk. Its vertices are all that there were."""
    kept = mesh.triangles[(limbs.limb >= 0)[mesh.triangles].all(1)]
    charted = mesh.uv_triangles[(limbs.limb >= 0)[mesh.triangles].all(1)]
    kept, charted = _closed(*_without_pinches(kept, charted))
    used, again = np.unique(charted, return_inverse=True)
    return replace(
        mesh,
        triangles=kept,
        corners=mesh.corners[used],
        uv=mesh.uv[used],
        uv_triangles=again.reshape(charted.shape).astype(np.int32),
    )


def _without_pinches(
    triangles: NDArray[np.int32], charted: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Triangles (T, 3), and the same of the chart, without those around vertices that open border passes twice."""
    while True:
        passes = np.bincount(open_edges(triangles).ravel())
        kept = ~(passes > 2)[np.minimum(triangles, len(passes) - 1)].any(1)
        if kept.all():
            return triangles, charted
        triangles, charted = triangles[kept], charted[kept]


def _closed(triangles: NDArray[np.int32], charted: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Triangles (T, 3), and the same of the chart, with every loop of open border filled by a fan: it is within the trunk."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    corners = np.concatenate([charted[:, [0, 1]], charted[:, [1, 2]], charted[:, [2, 0]]])
    count = int(triangles.max()) + 1
    back = np.isin(ends[:, 1] * count + ends[:, 0], ends[:, 0] * count + ends[:, 1])
    following = {int(b): int(a) for a, b in ends[~back]}  # the other way round: the fan's triangles look outwards
    corner = {int(a): int(c) for (a, _), (c, _) in zip(ends[~back], corners[~back], strict=True)}
    there = set((np.sort(ends, 1) @ [count, 1]).tolist())
    fans: list[tuple[int, int, int]] = []
    while following:
        at, loop = next(iter(following)), []
        while at in following:
            loop.append(at)
            at = following.pop(at)
        turned = (loop[k:] + loop[:k] for k in range(len(loop)))
        hub = next((one for one in turned if not _meets(one, there, count)), loop)
        fans += [(hub[0], b, c) for b, c in pairwise(hub[1:])]
    if not fans:
        return triangles, charted
    more = np.array(fans, np.int32)
    named = np.vectorize(corner.__getitem__)(more).astype(np.int32)
    return np.concatenate([triangles, more]), np.concatenate([charted, named])


def _meets(loop: list[int], edges: set[int], count: int) -> bool:
    """Whether a fan from the first of a loop's vertices has an edge that the surface has, too."""
    return any(min(loop[0], k) * count + max(loop[0], k) in edges for k in loop[2:-1])
