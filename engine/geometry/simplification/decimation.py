"""Fewer triangles, the same shape: edges are collapsed in the order of the error that this makes.

The quadric error metric of M. Garland and P. Heckbert, Surface simplification using quadric error metrics, SIGGRAPH
1997, with their boundary constraints (section 6) and check against flipped normals. Points are only ever removed, never
moved (a point goes to the other end of its edge), so that what remains keeps its texture coordinates and influences to
the bit. A point's copies along a seam of the texture go together or not at all.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.welding import weld
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.simplification.edge_collapse import collapse_edges

BORDER_WEIGHT = 30.0
"""Weight of the planes that hold open borders in place, against those of the surface."""

SEAM_PLANE_WEIGHT = 1.0
"""Weight of the planes that hold seams of the texture in place, against those of the surface: charts should keep their
outlines."""

INFLUENCE_WEIGHT = 0.02
"""How much points that move with other joints resist each other, as a share of their distance: joints stay supple."""


class Decimated(NamedTuple):
    """`mesh` has fewer triangles; `kept` (V',) int32: which vertices of the original its vertices are."""

    mesh: SkinnedMesh
    kept: NDArray[np.int32]


def decimate(mesh: SkinnedMesh, triangles: int, importance: NDArray[np.floating] | None = None) -> Decimated:
    """Bring a mesh down to at most `triangles` (fewer by one, at times), keeping its shape, silhouette and texture.

    Parameters
    ----------
    importance : (V,) factors (1 by default) on the error of removing a vertex: above 1 it stays longer (a face),
        below 1 it goes earlier; infinite ones stay for good.

    A closed surface stays closed; parts that only touch stay apart. Where seams, borders and flips forbid all further
    collapses, more triangles remain than asked for.
    """
    if len(mesh.triangles) <= triangles:
        return Decimated(mesh, np.arange(len(mesh.vertices), dtype=np.int32))
    point = weld(mesh)
    count = int(point.max()) + 1
    first = np.zeros(count, np.int32)
    first[point[::-1]] = np.arange(len(point) - 1, -1, -1)
    factors = np.ones(count)
    if importance is not None:
        factors[:] = 0
        np.maximum.at(factors, point, np.asarray(importance, np.float64))
    whole = point[mesh.triangles]
    used = (whole[:, 0] != whole[:, 1]) & (whole[:, 1] != whole[:, 2]) & (whole[:, 2] != whole[:, 0])
    corners = mesh.triangles[used].astype(np.int32)
    left = collapse_edges(
        mesh.vertices[first].astype(np.float64),
        point,
        corners,
        mesh.uv.astype(np.float64),
        mesh.bones[first],
        mesh.weights[first].astype(np.float64),
        factors,
        triangles,
        np.array([BORDER_WEIGHT, SEAM_PLANE_WEIGHT, INFLUENCE_WEIGHT]),
    )
    kept, index = np.unique(left, return_inverse=True)
    return Decimated(
        SkinnedMesh(
            mesh.skeleton,
            mesh.vertices[kept],
            index.reshape(-1, 3).astype(np.int32),
            mesh.uv[kept],
            mesh.bones[kept],
            mesh.weights[kept],
            mesh.texture,
        ),
        kept.astype(np.int32),
    )


def joint_importance(mesh: SkinnedMesh, factors: Mapping[str, float]) -> NDArray[np.float64]:
    """(V,) importance by joint: the mean of the factors of the joints that move a vertex, 1 for those not named.

    Names that the skeleton lacks are passed over.
    """
    by_joint = np.array([factors.get(name, 1.0) for name in mesh.skeleton.names])
    return (by_joint[mesh.bones] * mesh.weights).sum(1)
