"""Faces found and followed in real pictures: where they are, how many, and that they follow the picture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.media.image import read_image
from engine.media.video import read_video
from engine.perception.face.faces import FaceTracker, find_faces, overlapping_parts
from engine.perception.face.landmarks import MESH_SIZE, eye_distance, fiducials
from engine.performances import video

HALF = np.array([0.5, 0.5, 0])
"""From pixel centres to pixel corners, in which scaling is a product."""


def portrait(path: Path, longest: int) -> NDArray[np.uint8]:
    rgb = read_image(path).rgb
    scale = longest / max(rgb.shape[:2])
    return cv2.resize(rgb, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)


@pytest.fixture(scope="module")
def woman(media: Callable[[str], Path]) -> NDArray[np.uint8]:
    return portrait(media("portraits/photo_woman_outdoor.jpg"), 400)


@pytest.fixture(scope="module")
def mesh(woman: NDArray[np.uint8]) -> NDArray[np.float32]:
    found = find_faces(woman)
    assert len(found) == 1
    return found[0]


def apart(a: NDArray, b: NDArray) -> float:
    """Mean distance of the 68 points in eye distances."""
    unit = float(eye_distance(b[:, :2]))
    return float(np.linalg.norm(fiducials(a)[:, :2] - fiducials(b)[:, :2], axis=1).mean()) / unit


def test_a_mesh_has_irises_and_lies_in_the_picture(woman: NDArray, mesh: NDArray) -> None:
    assert mesh.shape == (MESH_SIZE, 3) and mesh.dtype == np.float32
    height, width = woman.shape[:2]
    assert ((mesh[:, :2] > 0) & (mesh[:, :2] < (width, height))).all()
    assert mesh[4, 2] < mesh[[234, 454], 2].min()  # the nose is nearer than the cheeks' rims


def test_pupils_are_dark_and_where_the_irises_are(woman: NDArray, mesh: NDArray) -> None:
    grey = cv2.cvtColor(woman, cv2.COLOR_RGB2GRAY).astype(float)
    for iris in (468, 473):
        x, y = mesh[iris, :2].round().astype(int)
        cheek = mesh[50 if iris == 468 else 280, :2].round().astype(int)
        assert grey[y - 1 : y + 2, x - 1 : x + 2].mean() < 0.7 * grey[cheek[1], cheek[0]]


@pytest.mark.parametrize("shift", [(37, 0), (0, 24)])
def test_a_shifted_picture_gives_a_shifted_mesh(woman: NDArray, mesh: NDArray, shift: tuple[int, int]) -> None:
    moved = cv2.copyMakeBorder(woman, shift[1], 0, shift[0], 0, cv2.BORDER_REPLICATE)
    assert apart(find_faces(moved)[0] - np.array([*shift, 0]), mesh) < 0.03


def test_a_scaled_picture_gives_a_scaled_mesh(woman: NDArray, mesh: NDArray) -> None:
    """Pixel centres: x of the small picture is 2 (x + 0.5) - 0.5 of the double one."""
    double = cv2.resize(woman, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC)
    found = find_faces(double)[0]
    assert apart((found + HALF) / 2 - HALF, mesh) < 0.03


def test_a_mirrored_picture_gives_a_mirrored_mesh(woman: NDArray, mesh: NDArray) -> None:
    from engine.perception.face.head_pose import mirror_vertices

    found = find_faces(np.ascontiguousarray(woman[:, ::-1]))[0]
    back = found[mirror_vertices()]
    back[:, 0] = woman.shape[1] - 1 - back[:, 0]
    assert apart(back, mesh) < 0.05


def test_several_faces_come_largest_first(woman: NDArray, media: Callable[[str], Path]) -> None:
    other = portrait(media("portraits/photo_biden.jpg"), 260)
    height = woman.shape[0]
    pasted = np.full((height, woman.shape[1] + other.shape[1], 3), 128, np.uint8)
    pasted[:, : woman.shape[1]] = woman
    pasted[: other.shape[0], woman.shape[1] :] = other
    found = find_faces(pasted)
    areas = [float(np.prod(np.ptp(m[:, :2], axis=0))) for m in found]
    assert len(found) == 2
    assert areas == sorted(areas, reverse=True)
    left = [bool(m[4, 0] < woman.shape[1]) for m in found]
    assert sorted(left) == [False, True]


def test_a_small_face_in_a_large_picture_is_found_and_measured_closely(woman: NDArray, mesh: NDArray) -> None:
    wide = np.full((900, 1200, 3), 110, np.uint8)
    small = cv2.resize(woman, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    wide[500 : 500 + small.shape[0], 800 : 800 + small.shape[1]] = small
    found = find_faces(wide)
    assert len(found) == 1
    expected = (mesh + HALF) / 2 - HALF + (800, 500, 0)
    assert apart(found[0], expected) < 0.05


@pytest.fixture(scope="module")
def cells(media: Callable[[str], Path]) -> list[NDArray[np.uint8]]:
    """Squares of 300 pixels, each with one person."""
    names = ("photo_woman_white.png", "photo_man_suit.png", "photo_biden.jpg", "photo_bw_einstein.jpg")
    pictures = [read_image(media(f"portraits/{name}")).rgb for name in names]
    return [
        cv2.resize(p[: min(p.shape[:2]), : min(p.shape[:2])], (300, 300), interpolation=cv2.INTER_AREA)
        for p in pictures
    ]


def of_each(found: list[NDArray[np.float32]], size: int, rows: int, columns: int) -> NDArray[np.int_]:
    """(rows, columns) how many of the faces lie in each cell of a grid."""
    count = np.zeros((rows, columns), int)
    for mesh in found:
        x, y = mesh[:, :2].mean(axis=0) // size
        count[int(y), int(x)] += 1
    return count


def test_who_is_small_beside_a_large_face_is_found(woman: NDArray, media: Callable[[str], Path]) -> None:
    """The tracker sees the large one alone, and used to be the only one to be asked."""
    large = cv2.resize(read_image(media("portraits/photo_man_suit.png")).rgb, (1200, 1200))
    scene = np.full((1200, 1600, 3), 128, np.uint8)
    scene[:, :1200] = large
    scene[300:700, 1200:] = portrait(media("portraits/photo_woman_white.png"), 400)
    with FaceTracker(8) as tracker:
        assert len(tracker(scene)) == 1
    first, second = find_faces(scene)
    assert first[4, 0] < 1200 < second[4, 0] and 300 < second[4, 1] < 700


@pytest.mark.parametrize(("rows", "columns"), [(1, 9), (3, 6), (6, 1)])
def test_everybody_of_a_group_is_found_once(cells: list[NDArray], rows: int, columns: int) -> None:
    group = np.vstack([np.hstack([cells[(x + y) % 4] for x in range(columns)]) for y in range(rows)])
    assert (of_each(find_faces(group), 300, rows, columns) == 1).all()


def test_no_more_are_looked_for_than_are_asked_for(cells: list[NDArray]) -> None:
    assert len(find_faces(np.hstack(cells[:3]), 1)) == 1
    assert len(find_faces(np.hstack([*cells] * 2), 5)) == 5


def test_a_tiny_face_in_a_large_picture_is_found(woman: NDArray, mesh: NDArray) -> None:
    """Of its 105 pixels, of 4000, the full-range detector gets five, in the whole picture."""
    large = np.full((3000, 4000, 3), 110, np.uint8)
    small = cv2.resize(woman, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    large[1900 : 1900 + small.shape[0], 2700 : 2700 + small.shape[1]] = small
    (found,) = find_faces(large)
    assert apart(found, (mesh + HALF) / 2 - HALF + (2700, 1900, 0)) < 0.05


@pytest.mark.parametrize(("shape", "side"), [((300, 1000), 400), ((777, 555), 777), ((777, 555), 200), ((90, 90), 200)])
def test_parts_cover_the_picture_and_hold_small_faces_whole(shape: tuple[int, int], side: int) -> None:
    """A face of a sixth of the part's side, wherever it is, lies whole in one of them."""
    parts = np.array(overlapping_parts(shape, side))
    assert (parts[:, :2] >= 0).all() and (parts[:, 2:] <= shape[::-1]).all()
    assert (np.ptp(parts.reshape(-1, 2, 2), axis=1) == np.minimum(shape[::-1], side)).all()
    face = min(side // 6, *shape)
    for x, y in np.random.default_rng(0).integers(0, np.array(shape[::-1]) - face + 1, (200, 2)):
        assert ((parts[:, :2] <= (x, y)) & (parts[:, 2:] >= (x + face, y + face))).all(axis=1).any()


@pytest.mark.parametrize(
    "name", ["portraits/photo_biden.jpg", "portraits/photo_bw_dylan.jpg", "fullbody/photo_bw_einstein_library.jpg"]
)
def test_one_person_has_one_face(media: Callable[[str], Path], name: str) -> None:
    """On the rim of the first one's face the tracker of several imagines another; the third stands before full shelves."""
    assert len(find_faces(read_image(media(name)).rgb)) == 1


@pytest.mark.parametrize("name", ["noise", "plain"])
def test_no_face_no_mesh(name: str) -> None:
    rng = np.random.default_rng(0)
    picture = {"noise": rng.integers(0, 255, (200, 200, 3), np.uint8), "plain": np.full((200, 200, 3), 90, np.uint8)}
    assert find_faces(picture[name]) == []


@pytest.mark.parametrize(
    "name",
    [
        "painting_mona_lisa.jpg",
        "cartoon_boy_3d.jpg",
        "photo_bw_einstein.jpg",
        "drawing_young_man.png",
        "painting_man_cap.png",
    ],
)
def test_paintings_cartoons_and_black_and_white_have_faces(media: Callable[[str], Path], name: str) -> None:
    found = find_faces(portrait(media(f"portraits/{name}"), 400))
    assert len(found) == 1


def test_a_still_is_settled(woman: NDArray, mesh: NDArray) -> None:
    """Asked twice it gives the same, bit for bit."""
    np.testing.assert_array_equal(find_faces(woman)[0], mesh)


def test_the_tracker_follows_a_moving_face(woman: NDArray) -> None:
    """A face that slides through the picture: the mesh's offset is the picture's, frame by frame, without lag."""
    positions = [np.array([2.0 * t, -1.0 * t]) for t in range(12)]
    meshes = []
    with FaceTracker() as tracker:
        for shift in positions:
            moved = cv2.warpAffine(
                woman, np.column_stack([np.eye(2), shift]), woman.shape[1::-1], borderMode=cv2.BORDER_REPLICATE
            )
            meshes.append(tracker(moved)[0])
    unit = float(eye_distance(meshes[0][:, :2]))
    centres = np.array([fiducials(m)[:, :2].mean(axis=0) for m in meshes])
    away = (centres - centres[3]) - (np.array(positions) - positions[3])
    assert np.linalg.norm(away[3:], axis=1).max() < 0.02 * unit


def test_the_tracker_says_when_the_face_is_gone(woman: NDArray) -> None:
    with FaceTracker() as tracker:
        assert len(tracker(woman)) == 1
        assert tracker(np.full_like(woman, 128)) == []
        assert len(tracker(woman)) == 1


def test_a_face_just_found_is_where_it_stays(woman: NDArray) -> None:
    """Also one that comes back: no jump in the first frames after."""
    with FaceTracker() as tracker:
        for _ in range(2):
            meshes = [tracker(woman)[0] for _ in range(6)]
            assert apart(meshes[0], meshes[-1]) < 0.01
            assert tracker(np.full_like(woman, 128)) == []


@pytest.fixture(scope="module")
def actor() -> NDArray[np.uint8]:
    return next(iter(read_video(video("idle")))).rgb


@pytest.mark.parametrize("longest", [130, 200])
def test_of_a_smaller_picture_the_mesh_is_where_the_pixels_are(actor: NDArray, longest: int) -> None:
    """Half a pixel of a small picture is a twentieth of an eye."""
    (whole,) = find_faces(actor)
    scale = longest / max(actor.shape[:2])
    small = cv2.resize(actor, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    (found,) = find_faces(small)
    ratio = np.array(small.shape[1::-1]) / actor.shape[1::-1]
    expected = (whole[:, :2] + 0.5) * ratio - 0.5
    assert np.abs((found[:, :2] - expected).mean(axis=0)).max() < 0.2, "pixels"


@pytest.mark.parametrize("longest", [120, 480])
def test_of_a_mirrored_picture_the_mesh_is_mirrored(actor: NDArray, longest: int) -> None:
    scale = longest / max(actor.shape[:2])
    small = cv2.resize(actor, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    (one,), (other,) = find_faces(small), find_faces(np.ascontiguousarray(small[:, ::-1]))
    off = (one[:, 0].mean() + other[:, 0].mean() - (small.shape[1] - 1)) / 2
    assert abs(off) < 0.0015 * np.ptp(one[:, 1]) + 0.15, "pixels"
