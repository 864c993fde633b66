"""Head pose by PnP on faces projected by a camera that the test knows; meshes from placed landmarks."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.errors import InputError
from engine.perception.face.head_pose import (
    FOCAL_LENGTH_SIDES,
    canonical_face,
    head_pose,
    mesh_from_fiducials,
    mirror_vertices,
)
from engine.perception.face.landmarks import MESH_SIZE, fiducials

SIZE = (640, 480)


def seen(
    yaw: float, pitch: float, roll: float, unit: float = 80.0, centre: tuple[float, float] = (0.0, 0.0)
) -> NDArray:
    """The canonical face turned by these angles (degrees), seen by a camera of the assumed focal length.

    `centre` is where the face is, in pixels from the picture's middle; x right, y down, z away.
    """
    y, p, r = np.deg2rad((yaw, pitch, roll))
    about_y = np.array([[np.cos(y), 0, -np.sin(y)], [0, 1, 0], [np.sin(y), 0, np.cos(y)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(p), -np.sin(p)], [0, np.sin(p), np.cos(p)]])
    about_z = np.array([[np.cos(r), -np.sin(r), 0], [np.sin(r), np.cos(r), 0], [0, 0, 1]])
    points = canonical_face().astype(float) @ (about_y @ about_x @ about_z).T
    focal = FOCAL_LENGTH_SIDES * max(SIZE)
    distance = focal / unit
    points = points + np.array([*(np.array(centre) / unit), distance])
    middle = (np.array(SIZE) - 1) / 2
    return np.column_stack([focal * points[:, :2] / points[:, 2:] + middle, unit * points[:, 2]])


@pytest.mark.parametrize("yaw", [-40, -25, 0, 10, 40])
@pytest.mark.parametrize("pitch", [-25, 0, 20])
def test_known_turns_are_recovered(yaw: float, pitch: float) -> None:
    pose = head_pose(seen(yaw, pitch, 0), SIZE)
    assert np.rad2deg(pose.yaw) == pytest.approx(yaw, abs=0.1)
    assert np.rad2deg(pose.pitch) == pytest.approx(pitch, abs=0.1)
    assert pose.error < 1e-4


@pytest.mark.parametrize("roll", [-30, 0, 15])
def test_roll_is_clockwise_and_does_not_count_as_a_turn(roll: float) -> None:
    mesh = seen(0, 0, roll)
    pose = head_pose(mesh, SIZE)
    assert np.rad2deg(pose.roll) == pytest.approx(roll, abs=0.1)
    assert abs(np.rad2deg(pose.yaw)) < 0.1 and abs(np.rad2deg(pose.pitch)) < 0.1
    eyes = mesh[263, :2] - mesh[33, :2]
    assert np.rad2deg(np.arctan2(eyes[1], eyes[0])) == pytest.approx(roll, abs=0.1)  # y is down: > 0 is clockwise


def test_signs_as_a_viewer_sees_them() -> None:
    """Yaw > 0: the nose points to the picture's right; pitch > 0: downwards."""
    rest, right, down = seen(0, 0, 0), seen(20, 0, 0), seen(0, 20, 0)
    assert right[4, 0] > rest[4, 0] + 5
    assert down[4, 1] > rest[4, 1] + 5


@pytest.mark.parametrize("unit", [20.0, 200.0])
@pytest.mark.parametrize("centre", [(0.0, 0.0), (-120.0, 60.0)])
def test_pose_is_against_the_line_of_sight(unit: float, centre: tuple[float, float]) -> None:
    """Whatever the size; a face that looks along the camera's axis from beside it is seen from the side."""
    pose = head_pose(seen(15, -10, 5, unit, centre), SIZE)
    sight = np.rad2deg(np.arctan(np.array(centre) / (FOCAL_LENGTH_SIDES * max(SIZE))))
    assert np.rad2deg([pose.yaw, pose.pitch]) == pytest.approx(np.array([15, -10]) + sight, abs=0.1)


def test_expressions_hardly_change_the_pose() -> None:
    mesh = seen(12, 5, 0)
    mesh[[61, 291, 13, 14, 17, 0], :2] += [[-6, -5], [6, -5], [0, -6], [0, 20], [0, 20], [0, -4]]
    pose = head_pose(mesh, SIZE)
    assert np.rad2deg([pose.yaw, pose.pitch]) == pytest.approx([12, 5], abs=1.0)


def test_canonical_face_is_symmetric_frontal_and_of_unit_eye_distance() -> None:
    face, mirror = canonical_face(), mirror_vertices()
    assert (mirror[mirror] == np.arange(MESH_SIZE)).all()
    np.testing.assert_allclose(face[mirror] * [-1, 1, 1], face, atol=1e-5)
    right, left = face[[33, 133]].mean(axis=0), face[[263, 362]].mean(axis=0)
    assert np.linalg.norm(left - right) == pytest.approx(1.0, abs=0.01)
    assert np.abs((left + right) / 2).max() < 0.05
    assert face[4, 2] < face[[234, 454], 2].min()  # the nose is nearest


@pytest.fixture(scope="module")
def placed() -> NDArray[np.float64]:
    """Landmarks as someone sets them on a drawing: another face's proportions, askew."""
    points = fiducials(seen(0, 0, 8, 60))[:, :2]
    rng = np.random.default_rng(3)
    return points * [1.2, 0.9] + rng.normal(0, 0.4, points.shape)


def test_mesh_passes_through_placed_landmarks(placed: NDArray) -> None:
    mesh = mesh_from_fiducials(placed)
    assert mesh.shape == (MESH_SIZE, 3) and mesh.dtype == np.float32
    assert np.abs(fiducials(mesh)[:, :2] - placed).max() < 0.5


def test_placed_landmarks_of_the_canonical_face_give_it_back() -> None:
    face = 70 * canonical_face() + (200, 150, 0)
    mesh = mesh_from_fiducials(fiducials(face)[:, :2])
    away = np.linalg.norm(mesh[:, :2] - face[:, :2], axis=1)
    assert away.max() < 0.02 * 70
    np.testing.assert_allclose(mesh[:, 2], face[:, 2], atol=1.0)


def test_mesh_from_landmarks_is_no_crumpled_one(placed: NDArray) -> None:
    """The plane is bent, not folded: triangles of the canonical face keep their sense."""
    from scipy.spatial import Delaunay

    rest, bent = canonical_face()[:468, :2], mesh_from_fiducials(placed)[:468, :2]
    triangles = Delaunay(rest[::3]).simplices * 3

    def area(p: NDArray) -> NDArray:
        a, b = p[triangles[:, 1]] - p[triangles[:, 0]], p[triangles[:, 2]] - p[triangles[:, 0]]
        return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]

    large = np.abs(area(rest)) > 1e-3
    assert (np.sign(area(rest)) == np.sign(area(bent)))[large].mean() > 0.98


@pytest.mark.parametrize(
    "points",
    [np.zeros((68, 2)), np.zeros((5, 2)), np.full((68, 2), np.nan), np.linspace(0, 300, 68)[:, None] * [1, 2]],
    ids=["one spot", "too few", "not finite", "one line"],
)
def test_points_that_are_no_face_are_refused(points: NDArray) -> None:
    with pytest.raises(InputError) as caught:
        mesh_from_fiducials(points)
    assert caught.value.code == "landmarks_invalid"
    assert caught.value.correctable == ("landmarks",)


def drawn(change: Callable[[NDArray], None]) -> NDArray[np.float64]:
    """Landmarks of a canonical face of 60 pixels between the eyes, after a change in eye distances."""
    points = fiducials(canonical_face())[:, :2].astype(float)
    change(points)
    return 60 * points + (150, 120)


def dots_and_a_line(points: NDArray) -> None:
    points[36:42], points[42:48] = points[36:42].mean(axis=0), points[42:48].mean(axis=0)
    points[27:36], points[48:, 1] = points[30], points[48:, 1].mean()


def huge_eyes(points: NDArray) -> None:
    for eye in (points[36:42], points[42:48]):
        eye += 1.5 * (eye - eye.mean(axis=0))
    points[17:27, 1] -= 0.6


def huge_mouth(points: NDArray) -> None:
    points[48:] += (points[48:] - points[48:].mean(axis=0)) * [1.2, 2.0]


def round_and_flat(points: NDArray) -> None:
    points *= [1.6, 0.6]


def upside_down(points: NDArray) -> None:
    points *= -1


@pytest.mark.parametrize("change", [dots_and_a_line, huge_eyes, huge_mouth, round_and_flat, upside_down])
def test_drawn_faces_are_faces(change: Callable[[NDArray], None]) -> None:
    """Emoji, cartoons, masks, and pictures that hang upside down."""
    points = drawn(change)
    assert np.abs(fiducials(mesh_from_fiducials(points))[:, :2] - points).max() < 4.0


@pytest.mark.parametrize("yaw", [-60, 60])
def test_turned_faces_are_faces(yaw: float) -> None:
    """Triangles on the far cheek are folded over, though the face is none the less one."""
    points = fiducials(seen(yaw, 0, 0, 60))[:, :2]
    assert np.abs(fiducials(mesh_from_fiducials(points))[:, :2] - points).max() < 1.0


@pytest.mark.parametrize("way", [(-1, 1), (1, -1)], ids=["left to right", "head over heels"])
def test_mirrored_landmarks_are_refused(way: tuple[int, int]) -> None:
    with pytest.raises(InputError, match="mirrored") as caught:
        mesh_from_fiducials(drawn(lambda points: None) * way + (600, 600))
    assert (caught.value.code, caught.value.correctable) == ("landmarks_invalid", ("landmarks",))


@pytest.mark.parametrize(
    "points",
    [
        np.random.default_rng(0).random((68, 2)) * 300,
        np.array([[200, 200], [100, 300], [250, 100], [220, 240]] * 17),
        np.random.default_rng(1).permutation(fiducials(canonical_face())[:, :2]) * 60 + 200,
    ],
    ids=["anywhere", "four spots", "another order"],
)
def test_points_without_a_face_s_order_are_refused(points: NDArray) -> None:
    with pytest.raises(InputError, match="order") as caught:
        mesh_from_fiducials(points)
    assert (caught.value.code, caught.value.correctable) == ("landmarks_invalid", ("landmarks",))


def test_pose_of_a_flat_picture_of_a_face_is_frontal(media) -> None:
    from engine.media.image import read_image
    from engine.perception.face.faces import find_faces

    picture = read_image(media("portraits/photo_woman_outdoor.jpg")).rgb
    scale = 400 / max(picture.shape[:2])
    small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    pose = head_pose(find_faces(small)[0], small.shape[1::-1])
    mirrored = head_pose(find_faces(np.ascontiguousarray(small[:, ::-1]))[0], small.shape[1::-1])
    assert abs(np.rad2deg(pose.yaw)) < 12
    assert np.rad2deg(mirrored.yaw) == pytest.approx(-np.rad2deg(pose.yaw), abs=3)
    assert np.rad2deg(mirrored.pitch) == pytest.approx(np.rad2deg(pose.pitch), abs=3)
