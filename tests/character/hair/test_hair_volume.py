"""Hair that falls beside a face: a shell around the head. The template stands for the person."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.figure.face_region import within_oval
from engine.character.fit.template_fit import load_human, pose_template
from engine.character.hair.colours import COLUMNS, INSIDE_COLUMNS, hair_round
from engine.character.hair.volume import HairedHead, hair_volume
from engine.character.parts.labels import HEAD_LABEL
from engine.character.shell.piece import Piece
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.mesh.welding import is_closed, same_rows
from engine.render.rasterisation.rasteriser import rasterise
from tests.character.shell.test_displacement import SHAPE, arms_down, covered, on_grid
from tests.character.shell.test_pieces import volume

SKIN, HAIR, HAT = (215, 170, 145), (50, 34, 26), (160, 30, 40)
STANDS_OFF, FALLS = 9, 14
"""Pixels that hair is wider than the head to each side, and ends below the chin."""


@pytest.fixture(scope="module")
def body() -> NDArray[np.float64]:
    return on_grid(pose_template(arms_down(), arms_down().picture_camera(), load_human()), template_mesh())


@pytest.fixture(scope="module")
def skull(body: NDArray[np.float64]) -> NDArray[np.float64]:
    return body[template_mesh().head > 0.9]


@pytest.fixture(scope="module")
def face(body: NDArray[np.float64]) -> NDArray[np.float64]:
    """The ellipse around the landmarks, and the forehead."""
    points = body[template_mesh().renamed(load_human().face), :2]
    low, high = points.min(0), points.max(0)
    low[1] -= 0.3 * (high[1] - low[1])
    return np.array([*(low + high) / 2, *(high - low) / 2, 0.0])


@pytest.fixture(scope="module")
def head(body: NDArray[np.float64]) -> NDArray[np.bool_]:
    """What the template's head and neck cover."""
    mesh = template_mesh()
    own = mesh.triangles[(mesh.parts[:, HEAD_LABEL] > 0.3)[mesh.triangles].all(1)]
    return np.asarray(rasterise(body * [1, 1, -1], own, SHAPE).triangle >= 0)


@pytest.fixture(scope="module")
def hair(skull: NDArray[np.float64], face: NDArray[np.float64]) -> NDArray[np.bool_]:
    """A bob: round above, straight beside the face, to below the chin."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    middle, half = float(np.median(skull[:, 0])), np.ptp(skull[:, 0]) / 2 + STANDS_OFF
    centre = skull[:, 1].min() - 4 + half
    dome = np.hypot(x - middle, y - centre) < half
    straight = (np.abs(x - middle) < half) & (y >= centre) & (y < skull[:, 1].max() + FALLS)
    beside = np.abs(x - face[0]) > 0.92 * face[2]
    return (dome | (straight & beside)) & ~within_oval(face * [1, 1, 0.92, 0.92, 1], SHAPE)


def noisy(rgb: NDArray[np.integer]) -> NDArray[np.uint8]:
    return np.clip(rgb + np.random.default_rng(1).normal(0, 4, rgb.shape), 0, 255).astype(np.uint8)


@pytest.fixture(scope="module")
def picture(hair: NDArray[np.bool_], skull: NDArray[np.float64]) -> NDArray[np.uint8]:
    """A hat over hair."""
    rows = np.arange(SHAPE[0])[:, None, None]
    brim = skull[:, 1].min() + 0.3 * np.ptp(skull[:, 1])
    return noisy(np.where(hair[..., None], np.where(rows < brim, HAT, HAIR), SKIN))


@pytest.fixture(scope="module")
def haired(body: NDArray[np.float64], hair: NDArray[np.bool_], picture: NDArray[np.uint8]) -> HairedHead:
    mesh = template_mesh()
    near = rasterise(body * [1, 1, -1], mesh.triangles, SHAPE)
    far = rasterise(body, mesh.triangles, SHAPE)
    front = np.where(near.triangle >= 0, -near.depth, -np.inf).astype(np.float32)
    back = np.where(far.triangle >= 0, far.depth, np.inf).astype(np.float32)
    made = hair_volume(mesh, body, picture, np.eye(2, 3), hair, front, back)
    assert made is not None
    return made


@pytest.fixture(scope="module")
def piece(haired: HairedHead) -> Piece:
    return haired.hair


def test_it_is_a_closed_shell_with_the_outline_of_the_hair(
    piece: Piece, body: NDArray[np.float64], hair: NDArray[np.bool_]
) -> None:
    assert is_closed(same_rows(piece.vertices)[piece.triangles]) and volume(piece) > 0
    np.testing.assert_allclose(piece.weights.sum(1), 1, atol=1e-6)
    own = rasterise(piece.vertices * [1, 1, -1], piece.triangles, SHAPE).triangle >= 0
    both = own | covered(body)
    wanted = hair | covered(body)
    assert (both & wanted).sum() > 0.985 * (both | wanted).sum()


def test_it_is_behind_the_head_and_before_its_sides_and_open_at_the_face(
    piece: Piece,
    body: NDArray[np.float64],
    skull: NDArray[np.float64],
    face: NDArray[np.float64],
    hair: NDArray[np.bool_],
) -> None:
    mesh = template_mesh()
    depths = []
    for towards in (1.0, -1.0):
        for places, triangles in ((piece.vertices, piece.triangles), (body, mesh.triangles)):
            raster = rasterise(places * [1, 1, -towards], triangles, SHAPE)
            depths.append(np.where(raster.triangle >= 0, -raster.depth, -np.inf))
    hair_front, body_front, hair_back, body_back = depths
    inner = within_oval(face * [1, 1, 0.8, 0.8, 1], SHAPE)
    assert (hair_front < body_front)[inner].mean() > 0.97
    assert (hair_front > body_front)[hair].mean() > 0.85
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    behind = (np.abs(x - np.median(skull[:, 0])) < 10) & (y > skull[:, 1].min() + 8) & (y < skull[:, 1].max())
    assert (hair_back > body_back)[behind].mean() > 0.97


def test_nothing_of_the_head_comes_through_it(haired: HairedHead, piece: Piece, hair: NDArray[np.bool_]) -> None:
    """Seen from four sides: where hair is at all it is outside, but for its border; the face is as it was."""
    mesh = template_mesh()
    own = mesh.triangles[(mesh.head > 0.5)[mesh.triangles].all(1)]
    within = rasterise(haired.pictured * [1, 1, -1], own, SHAPE)
    outside = rasterise(piece.vertices * [1, 1, -1], piece.triangles, SHAPE)
    both = (within.triangle >= 0) & cv2.erode(hair.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(bool)
    assert both.sum() > 200 and (outside.depth < within.depth)[both].mean() > 0.99
    back = rasterise(haired.pictured, own, SHAPE)
    cover = rasterise(piece.vertices, piece.triangles, SHAPE)
    above = (back.triangle >= 0) & (np.arange(SHAPE[0])[:, None] < haired.pictured[mesh.ear, 1].max())
    assert (cover.depth < back.depth)[above].mean() > 0.99


def test_the_face_is_left_as_it_was(haired: HairedHead, body: NDArray[np.float64]) -> None:
    points = template_mesh().renamed(load_human().face)[27:]
    np.testing.assert_allclose(haired.pictured[points], body[points], atol=0.7)
    assert (haired.framed[template_mesh().renamed(load_human().face)[[36, 45]]] > 0.9).all(), "hair is beside both eyes"


def test_around_the_back_it_has_the_colours_of_its_rows(piece: Piece) -> None:
    assert piece.colours is not None
    rgb = piece.colours.rgb.astype(float)
    assert rgb.shape[1] == COLUMNS + INSIDE_COLUMNS
    behind = np.concatenate([rgb[:, :20], rgb[:, COLUMNS - 20 : COLUMNS]], 1).mean(1)
    height = len(rgb)
    for rows, colour in ((slice(4, height // 8), HAT), (slice(height // 2, height - 4), HAIR)):
        assert np.abs(behind[rows] - colour).max() < 20


def test_inside_it_is_darker(piece: Piece) -> None:
    assert piece.colours is not None
    outside, inside = (one.astype(float).mean((0, 1)) for one in np.split(piece.colours.rgb, [COLUMNS], 1))
    assert (inside < 0.75 * outside).all()


def test_an_ear_among_hair_is_seen(
    body: NDArray[np.float64], hair: NDArray[np.bool_], face: NDArray[np.float64], picture: NDArray[np.uint8]
) -> None:
    """Hair that is tucked behind it: from before the ear's pixels are open, and from its side hair goes on behind it."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    ear = np.hypot((x - face[0] - face[2] - 3) / 4, (y - face[1]) / 9) < 1
    deep = np.where(covered(body), body[template_mesh().head > 0.9, 2].mean(), -np.inf).astype(np.float32)
    made = hair_volume(template_mesh(), body, picture, np.eye(2, 3), hair & ~ear, deep, deep - 10)
    assert made is not None
    own = made.hair.triangles[(made.hair.vertices[:, 2] > deep.max())[made.hair.triangles].all(1)]
    front = rasterise(made.hair.vertices * [1, 1, -1], own, SHAPE).triangle >= 0
    inner = cv2.erode(ear.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool)
    assert not front[inner].any()
    side = rasterise(made.hair.vertices[:, [2, 1, 0]] * [-1, 1, -1] + [SHAPE[1] / 2, 0, 0], made.hair.triangles, SHAPE)
    level = side.triangle[round(float(face[1]))]
    assert (level >= 0).sum() > 10


def test_a_lock_that_falls_on_one_side_alone_does_not_go_round_the_back(
    body: NDArray[np.float64],
    hair: NDArray[np.bool_],
    face: NDArray[np.float64],
    skull: NDArray[np.float64],
    picture: NDArray[np.uint8],
) -> None:
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    last = int(np.flatnonzero(hair.any(1))[-1])
    lock = (y > last - 2) & (y < last + 60) & (x > face[0] + face[2]) & (x < face[0] + face[2] + 14)
    deep = np.full(SHAPE, float(skull[:, 2].mean()), np.float32)
    made = hair_volume(template_mesh(), body, picture, np.eye(2, 3), hair | lock, deep, deep - 10)
    assert made is not None
    low = made.hair.vertices[made.hair.vertices[:, 1] > last + 20]
    assert low[:, 0].min() > face[0] + 0.4 * face[2]
    assert low[:, 1].max() > last + 55


def test_hair_that_is_nowhere_is_no_volume(body: NDArray[np.float64], picture: NDArray[np.uint8]) -> None:
    nothing = np.zeros(SHAPE, np.bool_)
    depth = np.zeros(SHAPE, np.float32)
    assert hair_volume(template_mesh(), body, picture, np.eye(2, 3), nothing, depth, depth) is None


def test_in_front_it_is_the_picture() -> None:
    """A cylinder of radius 20, of which the left side is dark and the right one light."""
    rows, angles = np.arange(40.0), np.linspace(-np.pi, np.pi, 40)
    ring = np.stack(np.broadcast_arrays(50 + 20 * np.sin(angles)[None], rows[:, None] + 10), 2)
    y, x = np.mgrid[:70, :100]
    hair = (np.abs(x - 50) < 20) & (y >= 10) & (y < 50)
    rgb = np.where(hair[..., None], np.where(x[..., None] < 50, 60, 160), 255).astype(np.uint8).repeat(3, 2)
    outside, _ = hair_round(rgb, np.eye(2, 3), hair, hair, ring, 40.0)
    found, turn = outside.astype(float), np.linspace(-np.pi, np.pi, COLUMNS)
    front = np.cos(turn) > 0.6
    assert np.abs(found[:, front & (np.sin(turn) > 0.3)] - 160).max() < 6
    assert np.abs(found[:, front & (np.sin(turn) < -0.3)] - 60).max() < 6
    assert 90 < found[:, 0].mean() < 130, "from one side to the other"


def test_an_ear_among_hair_gives_it_no_ring_of_its_colour() -> None:
    """A cylinder of dark hair, of which four rows are skin's colour all over what is seen."""
    angles = np.linspace(-np.pi, np.pi, 40)
    ring = np.stack(np.broadcast_arrays(50 + 20 * np.sin(angles)[None], np.arange(40.0)[:, None] + 10), 2)
    y, x = np.mgrid[:70, :100]
    hair = (np.abs(x - 50) < 20) & (y >= 10) & (y < 50)
    rgb = np.where(hair[..., None] & ((y < 28) | (y > 31))[..., None], HAIR, SKIN).astype(np.uint8)
    outside, _ = hair_round(rgb, np.eye(2, 3), hair, hair, ring, 40.0)
    assert np.abs(outside[:, :40].astype(float) - HAIR).max() < 25, "behind"


def test_beside_its_border_the_surface_shows_what_the_picture_does() -> None:
    """Hair on the left, a face on the right: what of the surface lies over the face by less than three pixels is the face's colour."""
    angles = np.linspace(-np.pi, np.pi, 200)
    ring = np.stack(np.broadcast_arrays(50 + 20 * np.sin(angles)[None], np.arange(40.0)[:, None] + 10), 2)
    y, x = np.mgrid[:70, :100]
    person = (np.abs(x - 50) < 20) & (y >= 10) & (y < 50)
    hair = person & (x < 50)
    rgb = np.where(hair[..., None], HAIR, SKIN).astype(np.uint8)
    outside, _ = hair_round(rgb, np.eye(2, 3), hair, person, ring, 40.0)
    turn = np.linspace(-np.pi, np.pi, COLUMNS)
    over = np.abs(20 * np.sin(turn) - 1.5) < 0.4
    over &= np.cos(turn) > 0.9
    assert over.any() and np.abs(outside[5:35, over].astype(float) - SKIN).max() < 12


def test_a_head_that_is_wider_than_its_hair_is_pressed_in(
    body: NDArray[np.float64], skull: NDArray[np.float64], face: NDArray[np.float64], picture: NDArray[np.uint8]
) -> None:
    """A narrow cap of hair: where it is seen from the front, from behind and from above the ears, nothing of the skull is outside of it."""
    mesh = template_mesh()
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    middle, half = float(np.median(skull[:, 0])), np.ptp(skull[:, 0]) / 2 - 3
    top = skull[:, 1].min() + 4
    cap = (np.hypot(x - middle, y - top - half) < half) & (y < face[1] - 0.3 * face[3])
    near = rasterise(body * [1, 1, -1], mesh.triangles, SHAPE)
    far = rasterise(body, mesh.triangles, SHAPE)
    front = np.where((near.triangle >= 0) & (cap | (y > face[1] - 0.3 * face[3])), -near.depth, -np.inf)
    back = np.where(far.triangle >= 0, far.depth, np.inf)
    made = hair_volume(mesh, body, picture, np.eye(2, 3), cap, front.astype(np.float32), back.astype(np.float32))
    assert made is not None
    own = mesh.triangles[((mesh.head > 0.5) & ~mesh.eye)[mesh.triangles].all(1)]
    high = (y > top + 3) & (y < face[1] - 0.5 * face[3])

    def comes_through(places: NDArray[np.float64]) -> int:
        found = 0
        for towards in (1.0, -1.0):
            skin = rasterise(places * [1, 1, -towards], own, SHAPE)
            hair = rasterise(made.hair.vertices * [1, 1, -towards], made.hair.triangles, SHAPE)
            bare = (skin.triangle >= 0) & ((hair.triangle < 0) | (skin.depth < hair.depth - 0.2)) & high
            found += int(bare.sum())
        return found

    assert comes_through(made.pictured) < 0.1 * comes_through(body)


def test_what_of_a_face_hair_frames(
    body: NDArray[np.float64], hair: NDArray[np.bool_], face: NDArray[np.float64], picture: NDArray[np.uint8]
) -> None:
    """Hair beside one half of a face alone."""
    x = np.arange(SHAPE[1])[None]
    above = np.arange(SHAPE[0])[:, None] < face[1] - 0.8 * face[3]
    deep = np.where(covered(body), body[template_mesh().head > 0.9, 2].mean(), -np.inf).astype(np.float32)
    made = hair_volume(template_mesh(), body, picture, np.eye(2, 3), hair & ((x > face[0]) | above), deep, deep - 10)
    assert made is not None
    eyes = template_mesh().renamed(load_human().face)[[36, 45]]
    one, other = made.framed[eyes[np.argsort(body[eyes, 0])]]
    assert one < 0.1 and other > 0.9


def test_of_its_border_nothing_is_seen_from_before(piece: Piece, hair: NDArray[np.bool_]) -> None:
    count = len(piece.vertices) // 3
    border = (piece.triangles >= 2 * count).any(1)
    shown = rasterise(piece.vertices * [1, 1, -1], piece.triangles, SHAPE).triangle
    assert border.any() and border[shown[shown >= 0]].mean() < 0.01
