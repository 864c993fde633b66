"""Face meshes with irises in pictures and video: MediaPipe Face Mesh behind a small interface."""

from __future__ import annotations

from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.perception.landmarks import MESH_SIZE
from engine.perception.solutions import solution

SETTLING_PASSES = 3
"""A mesh that was just found is looked at again in its own region this often; then it moves no more."""
SURE = 0.5
"""Confidence of a detection by which a picture is said to show several faces."""


class FaceTracker:
    """Follows the faces of a video, frame by frame; or sees each picture `alone`, once, whatever came before.

    Use as a context manager.
    """

    def __init__(self, faces: int = 1, confidence: float = 0.3, alone: bool = False):
        self._mesh = _face_mesh(faces, confidence, alone)
        self._alone, self._following = alone, False

    def __enter__(self) -> FaceTracker:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._mesh.close()

    def __call__(self, rgb: NDArray[np.uint8]) -> list[NDArray[np.float32]]:
        """The meshes in this frame, the largest first.

        Parameters
        ----------
        rgb : (H, W, 3) uint8.

        Returns
        -------
        Arrays (478, 3) float32: x and y in pixels, z in pixels of the same scale, smaller is nearer,
        0 near the head's middle.
        """
        rgb = np.ascontiguousarray(rgb)
        found = self._mesh.process(rgb).multi_face_landmarks or []
        if found and not (self._alone or self._following):
            for _ in range(SETTLING_PASSES):
                found = self._mesh.process(rgb).multi_face_landmarks or found
        self._following = bool(found)
        meshes = [_pixels(face, rgb.shape[:2]) for face in found]
        return sorted(meshes, key=_area, reverse=True)


def find_faces(rgb: NDArray[np.uint8], most: int = 8, confidence: float = 0.3) -> list[NDArray[np.float32]]:
    """All faces of a picture, the largest first, each looked at closely.

    Faces too small for the whole picture's scale are looked for by the full-range detector and then
    measured in a crop of their own. Shapes and units are those of `FaceTracker`.
    """
    with FaceTracker(most, confidence) as tracker:
        coarse = tracker(rgb)
    boxes = [_box(mesh[:, :2]) for mesh in coarse] or _detect(rgb, confidence)
    meshes: list[NDArray[np.float32]] = []
    for box in boxes:
        mesh = _settled(rgb, box, confidence)
        if mesh is not None and not any(_same(mesh, other) for other in meshes):
            meshes.append(mesh)
    return sorted(meshes, key=_area, reverse=True)


def _settled(rgb: NDArray[np.uint8], box: NDArray[np.float64], confidence: float) -> NDArray[np.float32] | None:
    """The mesh of the face in `box` (x0, y0, x1, y1), looked at on a crop of it until it is at rest."""
    height, width = rgb.shape[:2]
    centre, reach = (box[:2] + box[2:]) / 2, 1.25 * float((box[2:] - box[:2]).max())
    x0, y0 = np.maximum(np.floor(centre - reach), 0).astype(int)
    x1, y1 = np.minimum(np.ceil(centre + reach), (width, height)).astype(int)
    if x1 - x0 < 8 or y1 - y0 < 8:
        return None
    with FaceTracker(1, confidence) as tracker:
        meshes = tracker(rgb[y0:y1, x0:x1])
    return meshes[0] + np.array([x0, y0, 0], np.float32) if meshes else None


def several_faces(rgb: NDArray[np.uint8]) -> bool:
    """Whether a picture shows more than one face, by a quick look at those that are near."""
    return len(_detect(rgb, SURE, far=False)) > 1


def _detect(rgb: NDArray[np.uint8], confidence: float, far: bool = True) -> list[NDArray[np.float64]]:
    height, width = rgb.shape[:2]
    kind = solution("face_detection").FaceDetection
    with kind(model_selection=int(far), min_detection_confidence=confidence) as detector:
        found = detector.process(np.ascontiguousarray(rgb)).detections or []
    boxes = []
    for face in found:
        b = face.location_data.relative_bounding_box
        boxes.append(
            np.array([b.xmin * width, b.ymin * height, (b.xmin + b.width) * width, (b.ymin + b.height) * height])
        )
    return boxes


def _face_mesh(faces: int, confidence: float, alone: bool) -> Any:
    return solution("face_mesh").FaceMesh(
        static_image_mode=alone,
        refine_landmarks=True,
        max_num_faces=faces,
        min_detection_confidence=confidence,
        min_tracking_confidence=confidence,
    )


def _pixels(face: Any, shape: tuple[int, int]) -> NDArray[np.float32]:
    height, width = shape
    mesh = np.array([(p.x * width - 0.5, p.y * height - 0.5, p.z * width) for p in face.landmark], np.float32)
    assert mesh.shape == (MESH_SIZE, 3)
    return mesh


def _box(points: NDArray[np.floating]) -> NDArray[np.float64]:
    return np.concatenate([points.min(axis=0), points.max(axis=0)]).astype(float)


def _area(mesh: NDArray[np.float32]) -> float:
    return float(np.prod(np.ptp(mesh[:, :2], axis=0)))


def _same(a: NDArray[np.float32], b: NDArray[np.float32]) -> bool:
    return bool(np.linalg.norm(a[:, :2].mean(axis=0) - b[:, :2].mean(axis=0)) < 0.25 * np.sqrt(_area(a)))
