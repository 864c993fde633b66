"""What a tracked face does, in ARKit's face units: the weights with which the template's units explain its movements.

Each frame's mesh is laid on the face at rest by the vertices that expressions move little. What then differs is sought
as a mixture of the units' displacements, each between nothing and the whole. That is a quadratic programme with bounds.
A term that is linear in the weights keeps units at nothing that the rest explains as well. Frames are tied to their
neighbours.

Source: H. Li, T. Weise, M. Pauly, Example-based facial rigging, SIGGRAPH 2010, section 4.2 (blendshape weights by bounded
least squares); S. Bouaziz, Y. Wang, M. Pauly, Online modeling for realtime facial animation, SIGGRAPH 2013, equation 4 (the
terms for sparse and for smooth weights). Where the eyes look is told by the irises alone, within the picture: their lids
follow, and a mesh's depth there is a guess.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.body_space import BodySpace
from engine.body.face.face_mesh_points import FaceMeshPoints, face_mesh_points
from engine.body.face.face_points import PICTURE_TO_TEMPLATE
from engine.body.template import FACE_UNITS, Template
from engine.compiled import njit
from engine.geometry.registration.rigid import fit_similarities
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.perception.face.landmarks import LEFT_EYE, LEFT_IRIS, RIGHT_EYE, RIGHT_IRIS, RIGID_VERTICES, eye_distance

CAPTURED_UNITS = tuple(unit for unit in FACE_UNITS if unit != "tongueOut")
"""The face units that a face mesh shows: it has no tongue."""
GAZE_UNITS = tuple(unit for unit in CAPTURED_UNITS if unit.startswith("eyeLook"))
EYE_LANDMARK_VERTICES = {
    "Right": (RIGHT_EYE[0], RIGHT_EYE[8], RIGHT_IRIS[0]),
    "Left": (LEFT_EYE[0], LEFT_EYE[8], LEFT_IRIS[0]),
}
"""The outer and the inner corner of each eye, and its iris, as vertices of the tracked mesh."""
MAX_GAZE_TRAVEL_EYE_WIDTHS = {"In": 0.2, "Out": 0.2, "Up": 0.13, "Down": 0.17}
"""Eye widths that an iris travels in the picture when a unit of gaze is whole: eyeballs turn by 30 degrees aside, 25 up, 30 down."""
UNIT_DEPTH_WEIGHT = 0.1
"""What a difference in depth counts against one across the picture: a single camera guesses at depth."""
RIDGE_WEIGHT = 0.005
"""Weight of the squares of the weights, as a share of each unit's own sum of squares: all shrink alike by it."""
SPARSITY_WEIGHT = 0.01
"""Weight of the weights themselves, in eye distances by which all of a unit's points together have to move."""
SUBTLE_UNITS = (
    *(
        f"{unit}{side}"
        for unit in ("mouthDimple", "mouthLowerDown", "mouthPress", "noseSneer", "cheekSquint", "mouthUpperUp")
        for side in SIDE_NAMES
    ),
    *("cheekPuff", "jawForward", "mouthRollLower", "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper"),
)
"""Units that go with others, or move few points a little: taken for what a broad one would do but for the face's proportions."""
SUBTLE_SPARSITY_FACTOR = 4.0
"""By how much more weights of `SUBTLE_UNITS` cost."""
BLINK_GAIN_FACTOR = 1.35
"""By how much a blink is more than a tracked mesh shows of it: three quarters, measured on the project's own
performances."""
TEMPORAL_SMOOTHNESS_WEIGHT = 0.03
"""Weight of the squares of changes from frame to frame, as a share of each unit's own sum of squares."""
DESCENT_SWEEPS = 60
"""Rounds over all frames and units: the last changes weights by less than a thousandth."""


@dataclass(frozen=True)
class FaceUnitModel:
    """The face units at the vertices of the tracked mesh.

    `mesh` (P,) int: those vertices. `units` (U, P, 3) float64: the displacement of each of `CAPTURED_UNITS`, in eye
    distances, in the axes of pictures (y down, z away).
    """

    mesh: NDArray[np.intp]
    units: NDArray[np.float64]


def face_unit_model(template: Template, space: BodySpace) -> FaceUnitModel:
    """The units of the template's mean face, at the points that it shares with the tracked mesh."""
    points: FaceMeshPoints = face_mesh_points(template, space)
    eyes = [space.mean[template.vertices_of(f"{side}_eye")].mean(0) for side in ("left", "right")]
    unit = float(np.linalg.norm(eyes[0] - eyes[1]))
    moved = template.face_units.dense(CAPTURED_UNITS)[:, points.template].astype(np.float64)
    return FaceUnitModel(points.mesh, moved @ PICTURE_TO_TEMPLATE / unit)


def capture_face_units(
    model: FaceUnitModel, meshes: NDArray[np.floating], rest: NDArray[np.floating]
) -> NDArray[np.float64]:
    """Weights (N, U) in [0, 1] of `CAPTURED_UNITS` for the frames `meshes` (N, 478, 3) of a face that is `rest` (478, 3) when it
    does nothing, pixels."""
    at = model.mesh
    scale, rotation, shift = fit_similarities(rest, meshes, _rigid(len(rest)))
    laid = np.einsum("nji,nvj->nvi", rotation, meshes[:, at] - shift[:, None]) / scale[:, None, None]
    moved = (laid - rest[at]) / float(eye_distance(rest[None])[0])
    axes = np.array([1.0, 1.0, UNIT_DEPTH_WEIGHT])
    basis = (model.units * axes).reshape(len(model.units), -1)
    gaze = np.isin(CAPTURED_UNITS, GAZE_UNITS)
    basis[gaze] = 0
    gram = basis @ basis.T
    pull = (moved * axes).reshape(len(moved), -1) @ basis.T
    weights = np.zeros((len(moved), len(basis)))
    sparsity = SPARSITY_WEIGHT * np.where(np.isin(CAPTURED_UNITS, SUBTLE_UNITS), SUBTLE_SPARSITY_FACTOR, 1.0)
    _descend(gram, pull, sparsity, RIDGE_WEIGHT, TEMPORAL_SMOOTHNESS_WEIGHT, weights)
    for side in EYE_LANDMARK_VERTICES:
        blink = CAPTURED_UNITS.index(f"eyeBlink{side}")
        weights[:, blink] = np.minimum(BLINK_GAIN_FACTOR * weights[:, blink], 1)
        looks = [CAPTURED_UNITS.index(unit) for unit in GAZE_UNITS if unit.endswith(side)]
        weights[:, looks] = _gaze(meshes, rest, side) * (
            1 - weights[:, [blink]]
        )  # nothing is seen of an iris under its lid
    return weights


def head_rotations(meshes: NDArray[np.floating], rest: NDArray[np.floating]) -> NDArray[np.float64]:
    """How the head is turned in frames (N, 478, 3) against how it is at `rest` (478, 3): (N, 3, 3) in the template's axes."""
    _, rotation, _ = fit_similarities(rest, meshes, _rigid(len(rest)))
    return np.asarray(PICTURE_TO_TEMPLATE @ rotation @ PICTURE_TO_TEMPLATE)


def _rigid(count: int) -> NDArray[np.float64]:
    """Weights of a mesh's vertices: one for those that expressions move little."""
    weights = np.zeros(count)
    weights[list(RIGID_VERTICES)] = 1
    return weights


def _gaze(meshes: NDArray[np.floating], rest: NDArray[np.floating], side: str) -> NDArray[np.float64]:
    """Weights (N, 4) of an eye's `GAZE_UNITS`: how far its iris is from where it is at rest, along the line between the
    corners and across it."""
    inwards, down = (_iris(meshes, EYE_LANDMARK_VERTICES[side]) - _iris(rest[None], EYE_LANDMARK_VERTICES[side])).T
    travel = {"Down": down, "In": inwards, "Out": -inwards, "Up": -down}  # as they stand in the alphabet
    return np.stack([np.clip(moved / MAX_GAZE_TRAVEL_EYE_WIDTHS[unit], 0, 1) for unit, moved in travel.items()], axis=1)


def _iris(meshes: NDArray[np.floating], vertices: tuple[int, int, int]) -> NDArray[np.float64]:
    """(N, 2) an iris from the middle of its eye in eye widths: towards the nose, and down."""
    outer, inner, iris = (meshes[:, vertex, :2] for vertex in vertices)
    width = np.linalg.norm(inner - outer, axis=1, keepdims=True)
    along = (inner - outer) / width
    down = np.stack([-along[:, 1], along[:, 0]], axis=1)
    down *= np.sign(along[:, :1])  # of either eye, whose inner corners point to each other
    moved = iris - (outer + inner) / 2
    return np.stack([(moved * along).sum(1), (moved * down).sum(1)], axis=1) / width


@njit(nogil=True)
def _descend(
    gram: np.ndarray, pull: np.ndarray, sparsity: np.ndarray, ridge: float, smooth: float, weights: np.ndarray
) -> None:
    """Coordinate descent on weights (N, U) within [0, 1]: the least of w'Gw - 2w'p with the terms beside it, in place."""
    frames, units = weights.shape
    for _ in range(DESCENT_SWEEPS):
        for n in range(frames):
            for u in range(units):
                if gram[u, u] <= 0:
                    continue
                own = gram[u, u]
                rest = pull[n, u] - sparsity[u] * np.sqrt(own)
                for k in range(units):
                    if k != u:
                        rest -= gram[u, k] * weights[n, k]
                neighbours = 0.0
                if n > 0:
                    rest += smooth * own * weights[n - 1, u]
                    neighbours += smooth
                if n + 1 < frames:
                    rest += smooth * own * weights[n + 1, u]
                    neighbours += smooth
                weights[n, u] = min(max(rest / (own * (1 + ridge + neighbours)), 0.0), 1.0)
