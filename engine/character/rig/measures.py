"""What the method can say of its own result."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody
from engine.character.rig.left_out import LeftOut, left_out
from engine.character.rig.rigging import Character
from engine.geometry.camera import Camera
from engine.geometry.mesh.adjacency import unique_edges
from engine.geometry.mesh.welding import is_closed, weld
from engine.geometry.rigging.skinning import skin
from engine.imaging.masks.mask_pieces import rows_apart
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms
from engine.render.rasterisation.rasteriser import SUBPIXEL_STEPS, rasterise


def pose(character: Character, clip: Clip, frame: int = 0) -> NDArray[np.float32]:
    """The character's vertices (V, 3) in a frame of a clip."""
    mesh = character.mesh
    transforms = pose_transforms(mesh.skeleton, clip.rotations[[frame]], clip.root[[frame]])[0]
    return skin(mesh.vertices, mesh.bones, mesh.weights, transforms)


def picture_camera(character: Character, fitted: FittedBody, size: tuple[int, int]) -> Camera:
    """The picture's camera in the character's world; `size` (height, width) of the picture."""
    x, y, z = (float(value) for value in character.eye)
    return replace(fitted.camera, eye=(x, y, z), size=size)


@dataclass(frozen=True)
class Measured:
    """`figures` for the report, and what the character leaves out of the outline."""

    figures: dict[str, float]
    left_out: list[LeftOut]


def measure(figure: Figure, silhouette: Silhouette, fitted: FittedBody, character: Character) -> Measured:
    """Measure a character as it is pictured.

    silhouette_iou : how well the posed mesh covers the mask.
    landmark_reprojection : how far landmarks are from where they were seen, as a share of the person's height.
    closed, holes, non_manifold_edges : of the mesh; holes are loops of open border.
    flipped : the share of the pixels in view that show a triangle from its back.
    unseen_texture : the share of the surface that the picture does not show, whose colours are mirrored or filled.
    """
    height, width = figure.rgb.shape[:2]
    camera = picture_camera(character, fitted, (height, width))
    posed, triangles = pose(character, character.pictured), character.mesh.triangles
    projected = camera.project(posed)
    seen = rasterise(projected, triangles, (height, width), perspective=True).triangle
    drawn, mask = seen >= 0, silhouette.alpha > 0.5
    points = weld(character.mesh)
    border, crowded = border_edges(points[triangles])
    figures = {
        "silhouette_iou": round(float((drawn & mask).sum() / max((drawn | mask).sum(), 1)), 4),
        "landmark_reprojection": round(fitted.fit.reprojection / max(rows_apart(mask), 1), 4),
        "closed": float(is_closed(points[triangles])),
        "holes": float(count_loops(border)),
        "non_manifold_edges": float(crowded),
        "flipped": round(float((projected_areas(projected, triangles) < 0)[seen[drawn]].mean()), 5),
        "unseen_texture": round(unseen_share(posed, projected, triangles, seen[drawn]), 3),
        "triangles": float(len(triangles)),
    }
    return Measured(figures, left_out(mask, drawn))


def border_edges(faces: NDArray[np.integer]) -> tuple[NDArray[np.intp], int]:
    """The edges (E, 2) of one triangle alone, and how many have more than two."""
    found, which = unique_edges(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]))
    count = np.bincount(which)
    return found[count == 1], int((count > 2).sum())


def count_loops(border: NDArray[np.intp]) -> int:
    """How many loops edges (E, 2) make."""
    if not len(border):
        return 0
    names, ends = np.unique(border, return_inverse=True)
    a, b = ends.reshape(-1, 2).T
    graph = csr_matrix((np.ones(len(a)), (a, b)), (len(names), len(names)))
    return int(connected_components(graph, directed=False)[0])


def projected_areas(projected: NDArray[np.float32], triangles: NDArray[np.integer]) -> NDArray[np.float64]:
    """How many pixels each triangle covers (T,), fewer than none where it shows its back; y points down."""
    a, b, c = (projected[triangles[:, k], :2].astype(np.float64) for k in range(3))
    p, q = b - a, c - a
    return np.asarray(p[:, 1] * q[:, 0] - p[:, 0] * q[:, 1]) / 2


def unseen_share(
    posed: NDArray[np.float32],
    projected: NDArray[np.float32],
    triangles: NDArray[np.integer],
    seen: NDArray[np.integer],
) -> float:
    """The share of the surface of `posed` (V, 3) that no pixel shows. `seen` (N,): the triangle that each pixel shows, and of
    it as much as one pixel covers."""
    a, b, c = (posed[triangles[:, k]].astype(np.float64) for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    pixels = np.abs(projected_areas(projected, triangles)[seen])
    covered = np.maximum(pixels, 1 / SUBPIXEL_STEPS)  # finer than corners are placed
    return max(float(1 - (area[seen] / covered).sum() / max(float(area.sum()), 1e-12)), 0.0)
