"""Face meshes with irises in pictures and video: MediaPipe Face Mesh behind a small interface."""

from __future__ import annotations

from contextlib import AbstractContextManager
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import MESH_SIZE
from engine.perception.solutions import network

SETTLING_PASSES = 3
"""A mesh that was just found is looked at again in its own region this often; then it moves no more."""
MIN_CONFIDENCE = 0.5
"""Confidence of a detection by which a picture is said to show several faces."""
MAX_FACES = 20
"""Faces of a picture that are looked for, at most."""
MIN_DETECTED_SHARE = 1 / 12
"""Width of a face, as a share of the side of the square that is looked at, from which the full-range detector misses none.
Lone faces are found down to a half of it, and of the eighteen in a group of 1800 x 900 pixels, 0.07 wide, ten."""
MIN_SECOND_FACE_WIDTH = 1 / 3
"""Width of the least face that counts beside the largest one, in its widths: in the usual portrait, whose face takes a
quarter of the picture or more, nobody is looked for part by part."""
MAX_PARTS = 30
"""Parts of one size that are looked at, at most: who is smaller in a large picture is found in a crop of it."""
MIN_SEARCHED_PART_PIXELS = 450
"""Pixels of the least part that is looked at: faces that go unseen in it have eyes less than 16 pixels apart, and are too
small to be animated."""
CROP_HALF_SIDES = (1.25, 0.7)
"""Half sides of the crops on which a face is measured, in sides of its box; the narrow one is for faces that a detector
saw: on the rim of a large face the tracker takes whatever it is shown for another."""

CROP_SHIFT_SHARE = 0.003
"""Share of a face's longer side by which the network has it too far to the right and down: half a pixel of the crop that it sees. Of 57
pictures and their mirror images meshes are 0.0032 apart from the middle, and irises 0.0023 to 0.0026; nothing of it is left at size zero."""


class FaceTracker:
    """Follows the faces of a video, frame by frame; or sees each picture `alone`, once, whatever came before.

    Use as a context manager.
    """

    def __init__(self, faces: int = 1, confidence: float = 0.3, alone: bool = False):
        self._lent = _face_mesh(faces, confidence, alone)
        self._mesh = self._lent.__enter__()
        self._alone, self._following = alone, False

    def __enter__(self) -> FaceTracker:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lent.__exit__(kind, error, trace)

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


def find_faces(
    rgb: NDArray[np.uint8],
    most: int = MAX_FACES,
    confidence: float = 0.3,
    within: tuple[int, int, int, int] | None = None,
) -> list[NDArray[np.float32]]:
    """The faces of a picture, the largest first, each looked at closely; `most` of them at most.

    What the tracker sees by itself is near. All others are looked for by the full-range detector: in the whole picture, and
    in ever smaller parts of it as long as faces may be left that count beside the largest one found (`MIN_SECOND_FACE_WIDTH`). Each is
    then measured in a crop of its own, and is none if nothing is seen there. Shapes and units are those of `FaceTracker`.
    With `within` (x0, y0, x1, y1) they are those whose middle lies in that part of the picture, however small they are in
    the whole; measured by what is around them all the same.
    """
    x0, y0, x1, y1 = within or (0, 0, rgb.shape[1], rgb.shape[0])
    seen, corner = rgb[y0:y1, x0:x1], np.array([x0, y0, x0, y0])
    with FaceTracker(most, confidence) as tracker:
        near = [_box(mesh[:, :2]) + corner for mesh in tracker(seen)]
    meshes = _looked_at(rgb, near, [], most, CROP_HALF_SIDES[:1], confidence)
    side = max(seen.shape[:2])
    with _detector(confidence, far=True) as detector:
        while len(meshes) < most and len(parts := overlapping_parts(seen.shape, side)) <= MAX_PARTS:
            boxes = [box + corner for part in parts for box in _detected(detector, seen, part)]
            meshes = _looked_at(rgb, boxes, meshes, most, CROP_HALF_SIDES, confidence)
            least = max((MIN_SECOND_FACE_WIDTH * float(np.ptp(mesh[:, 0])) for mesh in meshes), default=0.0)
            if side * MIN_DETECTED_SHARE <= least or side < 2 * MIN_SEARCHED_PART_PIXELS:
                break
            side = -(-side // 2)
    middles = [(mesh, mesh[:, :2].mean(axis=0)) for mesh in meshes]
    meshes = [mesh for mesh, (x, y) in middles if within is None or (x0 <= x < x1 and y0 <= y < y1)]
    return sorted(meshes, key=_area, reverse=True)


def overlapping_parts(shape: tuple[int, ...], side: int) -> list[tuple[int, int, int, int]]:
    """Squares of this side, cut at the picture's edges, that cover a picture (H, W, ...): x0, y0, x1, y1. They overlap by a
    quarter, so that one of them holds the whole of each face that is too small to be seen in squares of twice the side."""
    starts = []
    for length in (shape[1], shape[0]):
        count = int(np.ceil(max(length - side, 0) / (0.75 * side))) + 1
        starts.append([int(start) for start in np.linspace(0, max(length - side, 0), count)])
    return [(x, y, min(x + side, shape[1]), min(y + side, shape[0])) for y in starts[1] for x in starts[0]]


def _looked_at(
    rgb: NDArray[np.uint8],
    boxes: list[NDArray[np.float64]],
    known: list[NDArray[np.float32]],
    most: int,
    reaches: tuple[float, ...],
    confidence: float,
) -> list[NDArray[np.float32]]:
    """The meshes that are `known`, and those of further faces in these boxes (x0, y0, x1, y1), larger ones first."""
    meshes = list(known)
    for box in sorted(boxes, key=lambda box: -float(np.prod(box[2:] - box[:2]))):
        if len(meshes) == most:
            break
        if any(_lies_on(mesh, box) for mesh in meshes):
            continue
        mesh = _settled(rgb, box, reaches, confidence)
        if mesh is not None and not any(same_face(mesh, other) for other in meshes):
            meshes.append(mesh)
    return meshes


def _settled(
    rgb: NDArray[np.uint8], box: NDArray[np.float64], reaches: tuple[float, ...], confidence: float
) -> NDArray[np.float32] | None:
    """The mesh of the face in `box` (x0, y0, x1, y1), looked at on a crop of it until it is at rest; on a narrower one where
    a neighbour is seen in the first instead. `reaches`: half sides of these crops, in sides of the box."""
    height, width = rgb.shape[:2]
    for reach in reaches:
        centre, half = (box[:2] + box[2:]) / 2, reach * float((box[2:] - box[:2]).max())
        x0, y0 = np.maximum(np.floor(centre - half), 0).astype(int)
        x1, y1 = np.minimum(np.ceil(centre + half), (width, height)).astype(int)
        if x1 - x0 < 8 or y1 - y0 < 8:
            return None
        with FaceTracker(1, confidence) as tracker:
            meshes = tracker(rgb[y0:y1, x0:x1])
        if not meshes:
            return None
        mesh = meshes[0] + np.array([x0, y0, 0], np.float32)
        if _lies_on(mesh, box):
            return mesh
    return None


def same_face(a: NDArray[np.float32], b: NDArray[np.float32]) -> bool:
    """Whether two meshes are of one face: they share half of the smaller one's place."""
    one, other = _box(a[:, :2]), _box(b[:, :2])
    shared = np.maximum(np.minimum(one[2:], other[2:]) - np.maximum(one[:2], other[:2]), 0)
    return bool(np.prod(shared) > 0.5 * min(_area(a), _area(b)))


def several_faces(rgb: NDArray[np.uint8]) -> bool:
    """Whether a picture shows more than one face, by a quick look at those that are near."""
    with _detector(MIN_CONFIDENCE, far=False) as detector:
        return len(_detected(detector, rgb, (0, 0, rgb.shape[1], rgb.shape[0]))) > 1


def _detector(confidence: float, far: bool) -> AbstractContextManager[Any]:
    return network("face_detection", "FaceDetection", model_selection=int(far), min_detection_confidence=confidence)


def _detected(detector: Any, rgb: NDArray[np.uint8], part: tuple[int, int, int, int]) -> list[NDArray[np.float64]]:
    """Boxes (4,) of the faces in a part of a picture, both as x0, y0, x1, y1 in pixels of the picture. Those that the
    part cuts are left out: other parts hold the whole of them."""
    x0, y0, x1, y1 = part
    size, whole = np.array([x1 - x0, y1 - y0]), np.array(rgb.shape[1::-1])
    boxes = []
    for face in detector.process(np.ascontiguousarray(rgb[y0:y1, x0:x1])).detections or []:
        box = face.location_data.relative_bounding_box
        low = np.array([x0, y0]) + size * [box.xmin, box.ymin]
        high = low + size * [box.width, box.height]
        before, after = low < [x0, y0], high > [x1, y1]
        if not (before & (np.array([x0, y0]) > 0)).any() and not (after & ([x1, y1] < whole)).any():
            boxes.append(np.concatenate([low, high]))
    return boxes


def _face_mesh(faces: int, confidence: float, alone: bool) -> AbstractContextManager[Any]:
    return network(
        "face_mesh",
        "FaceMesh",
        follows=not alone,
        static_image_mode=alone,
        refine_landmarks=True,
        max_num_faces=faces,
        min_detection_confidence=confidence,
        min_tracking_confidence=confidence,
    )


def _pixels(face: Any, shape: tuple[int, int]) -> NDArray[np.float32]:
    height, width = shape
    mesh = np.array([(p.x * width, p.y * height, p.z * width) for p in face.landmark], np.float32)
    assert mesh.shape == (MESH_SIZE, 3)
    mesh[:, :2] -= CROP_SHIFT_SHARE * np.ptp(mesh[:, :2], axis=0).max()
    return mesh


def _box(points: NDArray[np.floating]) -> NDArray[np.float64]:
    return np.concatenate([points.min(axis=0), points.max(axis=0)]).astype(float)


def _area(mesh: NDArray[np.float32]) -> float:
    return float(np.prod(np.ptp(mesh[:, :2], axis=0)))


def _lies_on(mesh: NDArray[np.float32], box: NDArray[np.float64]) -> bool:
    """Whether a mesh is that of the face in a box (x0, y0, x1, y1)."""
    found = _box(mesh[:, :2])
    apart = np.linalg.norm((found[:2] + found[2:] - box[:2] - box[2:]) / 2)
    return bool(apart < 0.5 * min(np.ptp(found.reshape(2, 2), axis=0).max(), (box[2:] - box[:2]).max()))
