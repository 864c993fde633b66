"""How long labels of a surface take: 40,000 nodes, 75 labels, a cost for each edge and pair of labels.

    python -m benchmarks.engine_figures.graph_cut [--nodes 40000] [--labels 75] [--sweeps 6]

Made as the textures of a person are, filmed by 75 cameras in a ring: triangles of a sphere, of which each is seen by the
cameras within 45 degrees of its normal. The data say how well, times the area. Seams say how far the views' colours are
apart at six samples of an edge, times its length. Prints the seconds, the energies and the edges between labels.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
import trimesh
from numpy.typing import NDArray

from engine.geometry.graph_cut import PairCost, energy, expansion_moves

VIEW_SAMPLES_PER_EDGE = 6
"""Of an edge, at which views are compared."""
MIN_COUNTED_VIEW_COSINE = np.cos(np.pi / 4)
"""Views that look at a triangle under a smaller cosine do not count."""
CLOTH_FOLD_SIGMA = 0.1
"""Of cloth: by how much normals are off, as unit vectors."""
CUT_SEAM_WEIGHT = 4.0
"""What seams weigh against data."""


def surface(nodes: int) -> tuple[NDArray, NDArray, NDArray]:
    """Unit normals (N, 3) of about so many triangles of a sphere, the pairs (E, 2) of those that share an edge, and the
    middles of these edges (E, 3)."""
    rows = round(np.sqrt(nodes / 8))
    mesh = trimesh.creation.uv_sphere(count=[rows, 2 * rows])
    edge = mesh.vertices[mesh.face_adjacency_edges].mean(1)
    return np.array(mesh.face_normals), np.asarray(mesh.face_adjacency), np.asarray(edge)


def views(labels: int) -> NDArray:
    """(L, 3) the directions from which cameras look, two rings as a person is filmed."""
    angle = 4 * np.pi * np.arange(labels) / labels
    height = np.where(np.arange(labels) < labels // 2, 0.35, -0.3)
    found = np.stack([np.cos(angle), height, np.sin(angle)], 1)
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))


def seam_cost(middles: NDArray, labels: int, random: np.random.Generator) -> PairCost:
    """How far two views are apart along an edge, of colours that are noise, an exposure of each view, and what it has
    shifted, smoothly over the surface."""
    waves, phases = random.normal(0, 6, (labels, 3)), random.uniform(0, 2 * np.pi, (labels, 3))
    smooth = np.sin((middles @ waves.T)[:, :, None] + phases)
    colours = np.empty((len(middles), labels, VIEW_SAMPLES_PER_EDGE, 3), np.uint8)
    for label in range(labels):
        noise = random.normal(0, 3, (len(middles), VIEW_SAMPLES_PER_EDGE, 3))
        colours[:, label] = np.clip(128 + random.normal(0, 4) + 15 * smooth[:, label, None] + noise, 0, 255)

    def cost(which: NDArray[np.intp], first: NDArray[np.intp], second: NDArray[np.intp]) -> NDArray:
        apart = colours[which, first].astype(np.float32) - colours[which, second]
        return CUT_SEAM_WEIGHT * np.sqrt((apart**2).sum(2)).mean(1) / 255

    return cost


def main() -> None:
    """Measure and print."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    arguments.add_argument("--nodes", type=int, default=40000)
    arguments.add_argument("--labels", type=int, default=75)
    arguments.add_argument("--sweeps", type=int, default=6)
    asked = arguments.parse_args()
    normals, edges, middles = surface(asked.nodes)
    random = np.random.default_rng(1)
    normals += random.normal(0, CLOTH_FOLD_SIGMA, normals.shape)
    seen = normals / np.linalg.norm(normals, axis=1, keepdims=True) @ views(asked.labels).T
    unary = np.where(seen > MIN_COUNTED_VIEW_COSINE, 1 - seen, np.inf)
    unary[~np.isfinite(unary).any(1)] = 1.0
    cost = seam_cost(middles, asked.labels, random)
    best_view = unary.argmin(1)
    print(f"{len(unary)} nodes, {len(edges)} edges, {asked.labels} labels, {np.isfinite(unary).sum(1).mean():.1f} each")
    expansion_moves(unary[:100], edges[(edges < 100).all(1)], cost, best_view[:100], 1)
    began = time.perf_counter()
    found = expansion_moves(unary, edges, cost, best_view, asked.sweeps)
    seconds = time.perf_counter() - began
    for name, labels in (("best view", best_view), ("expansion moves", found.labels)):
        differ = int((labels[edges[:, 0]] != labels[edges[:, 1]]).sum())
        total = energy(unary, edges, cost, labels)
        data = float(unary[np.arange(len(labels)), labels].sum())
        print(f"{name}: energy {total:.1f}, of it seams {total - data:.1f}, {differ} edges between labels")
    print(f"{seconds:.1f} s, {found.truncated} truncated")


if __name__ == "__main__":
    main()
