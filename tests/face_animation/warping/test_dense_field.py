"""The fast warp against a plain one that follows section 4 word by word, pixel by pixel."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import placed, smiling
from numpy.typing import NDArray
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay

from engine.face_animation.motion_transfer.contour import rim_distance
from engine.face_animation.motion_transfer.control_points import ControlPoints, place_control_points
from engine.face_animation.motion_transfer.head_proxy import contour_weights
from engine.face_animation.warping.contour_rings import rings_end
from engine.face_animation.warping.dense_field import (
    BLUR_KERNEL_COUNT,
    FALLOFF_DIAGONALS,
    LARGEST_DISK_DIAGONALS,
    build_warp_mesh,
    disk_radii,
    interpolation,
)
from engine.face_animation.warping.lip_edges import parted_lips
from engine.face_animation.warping.warp_mesh import WarpMesh
from engine.imaging.warping.delaunay import delaunay
from engine.imaging.warping.fold_edges import folded_box
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE

SHAPE = (260, 220)
UNIT, CENTRE = 40.0, (110.0, 100.0)


def pixels() -> NDArray[np.float64]:
    ys, xs = np.mgrid[: SHAPE[0], : SHAPE[1]]
    return np.stack([xs, ys], axis=-1).astype(float)


@pytest.fixture(scope="module")
def face() -> NDArray[np.float32]:
    return placed(UNIT, CENTRE)


@pytest.fixture(scope="module")
def control(face: NDArray) -> ControlPoints:
    person = np.zeros(SHAPE, np.float32)
    cv2.ellipse(person, (110, 110), (55, 75), 0, 0, 360, 1.0, -1)
    cv2.ellipse(person, (110, 260), (90, 75), 0, 0, 360, 1.0, -1)
    return place_control_points(face, person)


@pytest.fixture(scope="module")
def offsets(face: NDArray, control: ControlPoints) -> NDArray[np.float32]:
    """A smile in a head that shifts and tilts a little; restless peripheral points; a fixed border."""
    out = np.zeros((len(control.points), 2), np.float32)
    points = control.points - CENTRE
    head = np.array([5.0, -2.0]) + 0.05 * np.stack([-points[:, 1], points[:, 0]], axis=1)
    fade = 1 / (1 + np.exp((points[:, 1] - 110) / 12))
    out[:] = head * fade[:, None]
    smile = smiling(face, 0.15)[:, :2] - face[:, :2]
    out[:MESH_SIZE] += smile
    around = control.points[control.periphery]
    out[control.periphery] += contour_weights(face, around) @ smile[list(FACE_OVAL)]
    beyond = rim_distance(face, around) > rings_end(face)
    out[control.periphery][beyond] += np.random.default_rng(0).normal(0, 0.7, (beyond.sum(), 2))
    out[control.border] = 0
    return out


@pytest.fixture(scope="module")
def mesh(control: ControlPoints, face: NDArray) -> WarpMesh:
    return build_warp_mesh(control.points, face, SHAPE)


@pytest.fixture(scope="module")
def outside(face: NDArray) -> NDArray[np.float64]:
    """Pixels from the face's contour, (H, W); negative inside."""
    oval = face[list(FACE_OVAL), :2]
    flat = [-cv2.pointPolygonTest(oval, (float(x), float(y)), True) for x, y in pixels().reshape(-1, 2)]
    return np.array(flat).reshape(SHAPE)


def plain_field(control: NDArray, offsets: NDArray, outside: NDArray) -> NDArray[np.float64]:
    """Forward offsets of every pixel: interpolated over the triangulation, then blurred by ten disks."""
    field = LinearNDInterpolator(Delaunay(control), offsets.astype(float))(pixels())
    diagonal = float(np.hypot(*SHAPE))
    level = np.round(np.clip(outside / (FALLOFF_DIAGONALS * diagonal), 0, 1) * (BLUR_KERNEL_COUNT - 1)).astype(int)
    out = field.copy()
    for k in range(1, BLUR_KERNEL_COUNT):
        radius = k / (BLUR_KERNEL_COUNT - 1) * LARGEST_DISK_DIAGONALS * diagonal
        reach = int(np.ceil(radius))
        y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
        disk = (x**2 + y**2 <= radius**2).astype(float)
        blurred = cv2.filter2D(field, cv2.CV_64F, disk / disk.sum(), borderType=cv2.BORDER_REPLICATE)
        out[level == k] = blurred[level == k]
    return out


def plain_inverse(field: NDArray) -> NDArray[np.float64]:
    """Origin of every pixel: the place q with q + field(q) = p, found by iteration (the field is no folding one)."""
    p, forward = pixels().astype(np.float32), field.astype(np.float32)
    q = p
    for _ in range(200):
        q = p - cv2.remap(forward, q[..., 0], q[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    again = q + cv2.remap(forward, q[..., 0], q[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    assert np.abs(again - p).max() < 0.05
    return q


@pytest.fixture(scope="module")
def compared(control: ControlPoints, offsets: NDArray, outside: NDArray, mesh: WarpMesh) -> NDArray[np.float64]:
    """(H, W) pixels between the two origins; the outermost three rows and columns are left out."""
    plain = plain_inverse(plain_field(control.points, offsets, outside))
    fast = mesh.inverse_map(mesh.offsets(offsets))
    away = np.linalg.norm(plain - fast, axis=-1)
    away[:3] = away[-3:] = away[:, :3] = away[:, -3:] = 0
    return away


def test_the_fast_warp_is_the_plain_one(compared: NDArray, outside: NDArray) -> None:
    """In the mean 0.02 pixels apart on the face and 0.1 outside; most where one disk gives way to the next."""
    assert compared[outside < 0].mean() < 0.02
    assert compared[outside < 0].max() < 0.4
    assert compared[outside >= 0].mean() < 0.1
    assert compared.max() < 1.2


def test_on_the_face_it_is_piecewise_linear_and_unsmoothed(mesh: WarpMesh, control: ControlPoints, offsets) -> None:
    """Each vertex of the face's own mesh goes exactly where its control point goes, but that closed lips have a gap."""
    moved = mesh.offsets(offsets)
    np.testing.assert_allclose(mesh.vertices[:MESH_SIZE], parted_lips(control.points[:MESH_SIZE]), atol=1e-4)
    np.testing.assert_allclose(moved[:MESH_SIZE], offsets[:MESH_SIZE], atol=1e-5)


def test_no_motion_is_the_identity(mesh: WarpMesh, control: ControlPoints) -> None:
    origin = mesh.inverse_map(mesh.offsets(np.zeros((len(control.points), 2))))
    np.testing.assert_allclose(origin, pixels(), atol=2e-3)


@pytest.mark.parametrize("smoothing", ["none", "constant", "confidence"])
def test_if_all_points_do_the_same_so_does_the_picture(control: ControlPoints, face: NDArray, smoothing: str) -> None:
    mesh = build_warp_mesh(control.points, face, SHAPE, smoothing)
    moved = mesh.offsets(np.full((len(control.points), 2), (4.0, -3.0)))
    np.testing.assert_allclose(moved, np.broadcast_to([4.0, -3.0], moved.shape), atol=1e-4)
    origin = mesh.inverse_map(moved)
    inside = (slice(0, SHAPE[0] - 4), slice(5, SHAPE[1]))
    np.testing.assert_allclose(origin[inside], pixels()[inside] - (4, -3), atol=5e-3)


def test_origins_in_an_enlarged_picture_keep_to_pixel_centres(mesh: WarpMesh, offsets: NDArray) -> None:
    one, two = (mesh.inverse_map(mesh.offsets(offsets), scale=s) for s in (1, 2))
    covered = one[..., 0] > -1000
    np.testing.assert_allclose((two[covered] + 0.5) / 2 - 0.5, one[covered], atol=2e-3)


def test_every_pixel_has_an_origin(mesh: WarpMesh, offsets: NDArray) -> None:
    """The border holds, so nothing uncovered comes into the picture."""
    origin = mesh.inverse_map(mesh.offsets(offsets))
    assert (origin[4:-4, 4:-4] > -1000).all()


def jumps(control: ControlPoints, face: NDArray, offsets: NDArray, smoothing: str) -> NDArray[np.float64]:
    """How much the field's slope jumps at each pixel: second differences of the origins."""
    mesh = build_warp_mesh(control.points, face, SHAPE, smoothing)
    origin = mesh.inverse_map(mesh.offsets(offsets)).astype(float)
    second = [np.diff(origin, 2, axis=k) for k in (0, 1)]
    return np.hypot(*(np.linalg.norm(s, axis=-1)[: SHAPE[0] - 2, : SHAPE[1] - 2] for s in second))


def test_smoothing_as_figure_3_shows_it(control: ControlPoints, face: NDArray, offsets: NDArray, outside) -> None:
    """Without it the field breaks outside the face (b); a constant blur takes the smile away (c); ours does neither."""
    around = outside[1:-1, 1:-1] > 0.06 * np.hypot(*SHAPE)
    around[:8] = around[-8:] = around[:, :8] = around[:, -8:] = False
    broken = {s: float(np.quantile(jumps(control, face, offsets, s)[around], 0.99)) for s in ("none", "confidence")}
    assert broken["confidence"] < 0.6 * broken["none"]

    corners = [61, 291]
    asked = offsets[corners] - offsets[4]
    smile = {}
    for smoothing in ("none", "confidence", "constant"):
        mesh = build_warp_mesh(control.points, face, SHAPE, smoothing)
        moved = mesh.offsets(offsets)
        got = moved[corners] - moved[4]
        smile[smoothing] = float(np.linalg.norm(got, axis=1).mean() / np.linalg.norm(asked, axis=1).mean())
    assert smile["none"] == pytest.approx(1, abs=1e-3)
    assert smile["confidence"] == pytest.approx(1, abs=1e-3)
    assert smile["constant"] < 0.9


def test_disks_grow_from_nothing_to_five_hundredths_of_the_diagonal_in_ten_steps(face: NDArray) -> None:
    diagonal = float(np.hypot(*SHAPE))
    top = face[10, :2].astype(float)
    line = np.array([[top[0], top[1] - d] for d in np.linspace(-20, 0.3 * diagonal, 400)])
    radii = disk_radii(face, line, SHAPE)
    assert (np.diff(radii) >= 0).all()
    assert radii[0] == 0 and radii[-1] == pytest.approx(LARGEST_DISK_DIAGONALS * diagonal)
    assert len(np.unique(radii.round(6))) == BLUR_KERNEL_COUNT
    assert (disk_radii(face, face[:, :2], SHAPE) == 0).all()


def test_interpolation_is_exact_for_planes_and_holds_beyond_the_hull() -> None:
    rng = np.random.default_rng(0)
    control = rng.uniform(0, 100, (30, 2))
    inside = rng.uniform(35, 65, (50, 2))
    corners, weights = interpolation(control, delaunay(control), inside)
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    assert weights.min() >= -1e-9
    plane = control @ [2.0, -1.0] + 3
    np.testing.assert_allclose((weights * plane[corners]).sum(axis=1), inside @ [2.0, -1.0] + 3, atol=1e-9)
    nearest = int(np.argmin(np.linalg.norm(control - (-500, -500), axis=1)))
    corners, weights = interpolation(control, delaunay(control), np.array([[-500.0, -500.0]]))
    assert corners[0, 0] == nearest and weights[0].tolist() == [1, 0, 0]


def test_interpolation_is_scipys() -> None:
    rng = np.random.default_rng(1)
    control, points = rng.uniform(0, 100, (60, 2)), rng.uniform(-10, 110, (500, 2))
    values = rng.normal(size=60)
    corners, weights = interpolation(control, delaunay(control), points)
    theirs = LinearNDInterpolator(control, values)(points)
    known = np.isfinite(theirs)
    assert 250 < known.sum() < 400
    np.testing.assert_allclose((weights * values[corners]).sum(axis=1)[known], theirs[known], atol=1e-9)


def test_points_that_are_not_usable_move_nothing(control: ControlPoints, face: NDArray, offsets: NDArray) -> None:
    usable = np.ones(len(control.points), bool)
    usable[[454, 323, 361]] = False
    mesh = build_warp_mesh(control.points, face, SHAPE, "confidence", usable)
    wild = offsets.copy()
    wild[~usable] = 300
    np.testing.assert_array_equal(mesh.offsets(wild), mesh.offsets(offsets))


def test_where_the_sheet_folds_the_nearer_side_is_seen(mesh: WarpMesh, offsets: NDArray) -> None:
    """Only there is depth looked at; the whole picture drawn with depth is the same."""
    moved = mesh.offsets(offsets)
    middle = np.linalg.norm(mesh.vertices - CENTRE, axis=1) < 0.4 * UNIT
    moved[middle, 0] += 0.8 * UNIT
    depth = np.where(middle, 1.0, 2.0).astype(np.float32)
    left, top, right, bottom = folded_box(mesh.vertices + moved, mesh.triangles, SHAPE)
    assert 0 < left < right < SHAPE[1] and 0 < top < bottom < SHAPE[0]
    plain = inverse_map(mesh.vertices + moved, mesh.vertices, mesh.triangles, SHAPE, depth)
    assert np.quantile(np.abs(mesh.inverse_map(moved, depth) - plain), 0.999) < 0.01
    behind = mesh.inverse_map(moved, -depth)
    assert np.abs(behind - plain)[top:bottom, left:right].max() > 0.3 * UNIT
