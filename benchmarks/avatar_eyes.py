"""How an avatar's eyes are off: lids and irises that a tracker sees in it and in the known person, from the same cameras.

    python -m benchmarks.avatar_eyes FOLDER OUT [--sheet OUT.png]

FOLDER is what `python -m benchmarks.scan_studio` made of a subject, OUT what `python -m benchmarks.avatar` made of it.
Both are drawn without light from those true cameras of the head's film from which the tracker sees the true face from
the front; what the tracker gets wrong of both alike is no error. Prints, in millimetres, how much wider apart the
avatar's lids are, in the mean over an eye and at the most. Also how much larger its irises are, and by how much these
stand elsewhere between the corners of the eye. Medians over frames and both eyes.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.avatar import cameras_of, onto_truth
from benchmarks.presentation.contact_sheet import Row, contact_sheet, write_sheet
from benchmarks.presentation.tables import table
from benchmarks.scan_studio.comparison.distance import measured_surface
from benchmarks.scan_studio.people.rigged_glb import read_in_clip
from benchmarks.scan_studio.scenery.drawing import TexturedMesh, draw_over, empty_depths, textured_mesh
from benchmarks.scan_studio.truth import Truth, read_truth
from engine.avatar.landmarks.in_frames import EYE_MESH_VERTICES
from engine.avatar.landmarks.spatial import LID_POINT_COUNT
from engine.geometry.camera import Camera
from engine.perception.face.faces import find_faces

ASKED_FRAME_STEP = 2
"""Each so many frames of the head's film are asked."""
FRAME_ENLARGEMENT = 2.0
"""By how much larger than the film's frames they are drawn."""
MAX_ASKED_NOSE_OFFSET_SHARE = 0.35
"""Of half the distance between the eyes' outer corners, what the nose may stand off their middle."""
NOSE_FRONT_VERTEX, RIGHT_EYE_CORNER_VERTEX, LEFT_EYE_CORNER_VERTEX = 1, 33, 263
"""Vertices of the face mesh."""
BACKGROUND_GREY_LEVEL = 110


@dataclass(frozen=True)
class Drawn:
    """Somebody as they can be drawn: `mesh`, and `vertices` (V, 3) in the axes of the true person."""

    mesh: TexturedMesh
    vertices: NDArray[np.float64]

    def seen(self, camera: Camera) -> NDArray[np.uint8]:
        """(H, W, 3) from a camera."""
        picture = np.full((*camera.size, 3), BACKGROUND_GREY_LEVEL, np.uint8)
        draw_over(picture, empty_depths(camera), self.mesh, self.vertices, camera)
        return picture


def eye_errors(person: Drawn, avatar: Drawn, cameras: list[Camera]) -> NDArray[np.float64]:
    """(N, 4) of frames and eyes, millimetres: how much wider the avatar's lids are apart, in the mean and at the most, how much
    larger the iris is, and how far it stands elsewhere."""
    rows = []
    for camera in cameras:
        true = _face(person.seen(camera))
        if true is None or not _frontal(true):
            continue
        mine = _face(avatar.seen(camera))
        if mine is None:
            continue
        for points in EYE_MESH_VERTICES:
            scale = _pixels_per_metre(person, camera, true[points])
            rows.append(1000 * (_measures(mine[points], true[points]) / scale))
    return np.array(rows).reshape(-1, 4)


def _face(picture: NDArray[np.uint8]) -> NDArray[np.float64] | None:
    found = find_faces(picture, most=1)
    return found[0][:, :2].astype(np.float64) if found else None


def _frontal(mesh: NDArray[np.float64]) -> bool:
    across = mesh[LEFT_EYE_CORNER_VERTEX] - mesh[RIGHT_EYE_CORNER_VERTEX]
    off = (
        (mesh[NOSE_FRONT_VERTEX] - (mesh[LEFT_EYE_CORNER_VERTEX] + mesh[RIGHT_EYE_CORNER_VERTEX]) / 2)
        @ across
        / (across @ across)
    )
    return bool(abs(off) < MAX_ASKED_NOSE_OFFSET_SHARE / 2)


def _measures(mine: NDArray[np.float64], true: NDArray[np.float64]) -> NDArray[np.float64]:
    """Pixels: what `eye_errors` tells of one eye, (21, 2) each."""
    half = LID_POINT_COUNT // 2
    gaps, irises, places = [], [], []
    for eye in (mine, true):
        gaps.append(np.linalg.norm(eye[1:half] - eye[LID_POINT_COUNT - 1 : half : -1], axis=1))
        irises.append(np.linalg.norm(eye[LID_POINT_COUNT + 1] - eye[LID_POINT_COUNT + 3]) / 2)
        places.append(eye[LID_POINT_COUNT] - (eye[0] + eye[half]) / 2)
    return np.array(
        [
            gaps[0].mean() - gaps[1].mean(),
            gaps[0].max() - gaps[1].max(),
            irises[0] - irises[1],
            np.linalg.norm(places[0] - places[1]),
        ]
    )


def _pixels_per_metre(person: Drawn, camera: Camera, eye: NDArray[np.float64]) -> float:
    """Where the person's nearest vertices are that lie behind an eye (21, 2)."""
    projected = camera.project(person.vertices)
    near = np.linalg.norm(projected[:, :2] - eye.mean(0), axis=1) < np.ptp(eye[:LID_POINT_COUNT, 0])
    return float(camera.focal / np.quantile(projected[near, 2], 0.1))


def person_drawn(truth: Truth) -> Drawn:
    """The true person, without light."""
    one = truth.subject
    shade = np.ones(len(one.vertices), np.float32)
    return Drawn(textured_mesh(one.triangles, one.uv, one.uv_triangles, shade, one.texture), one.vertices)


def avatar_drawn(out: Path, truth: Truth) -> Drawn:
    """The delivered avatar, in the pose in which the person was filmed, laid on the true one."""
    (part,) = read_in_clip(out / "avatar.glb", "filmed")
    surface = measured_surface(truth.subject.vertices, truth.subject.triangles)
    motion = onto_truth(cameras_of(out)["body"], truth, part.vertices, surface)
    triangles = part.triangles.astype(np.int32)
    shade = np.ones(len(part.vertices), np.float32)
    mesh = textured_mesh(triangles, part.uv.astype(np.float32), triangles, shade, part.image)
    return Drawn(mesh, motion(part.vertices))


def head_cameras(truth: Truth) -> list[Camera]:
    """True cameras of the head's film, in the axes of the person."""
    count = len(truth.films["head"].cameras)
    return [truth.person_camera("head", k).scaled(FRAME_ENLARGEMENT) for k in range(0, count, ASKED_FRAME_STEP)]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--sheet", type=Path)
    asked = parser.parse_args()
    truth = read_truth(asked.folder)
    person, avatar = person_drawn(truth), avatar_drawn(asked.out, truth)
    cameras = head_cameras(truth)
    found = eye_errors(person, avatar, cameras)
    if not len(found):
        raise SystemExit("the tracker sees no face from the front in both")
    names = ["eyes", "lids apart", "at the most", "iris", "iris elsewhere"]
    print(table("Eyes, mm", names, [[str(len(found)), *(f"{value:.2f}" for value in np.median(found, 0))]]))
    if asked.sheet:
        shown = cameras[:: max(1, len(cameras) // 6)]
        rows = [Row([one.seen(camera) for camera in shown], name) for one, name in ((person, "true"), (avatar, "made"))]
        write_sheet(asked.sheet, contact_sheet(rows, max_width=3000))


if __name__ == "__main__":
    main()
