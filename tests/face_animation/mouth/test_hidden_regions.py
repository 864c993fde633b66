"""The mouth's inside: when it appears, where, and in whose colours."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from made_face import DARK, SKIN, in_crop, opened, painted, placed
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import (
    APPEARING_AREA,
    APPEARING_GAP,
    FULL_AREA,
    FULL_GAP,
    MIN_INNER_AREA,
    MouthPalette,
    match_palette,
    mouth_triangles,
    relight,
    transfer_mouth,
)
from engine.perception.face_track.face_crop import CROP_SHAPE
from engine.perception.landmarks import LIPS_INNER, LIPS_OUTER

SIZE = (320, 340)
TEETH = (240, 235, 225)


@pytest.fixture(scope="module")
def closed() -> NDArray[np.float32]:
    return placed(90, (160, 120))


@pytest.fixture(scope="module")
def driver() -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """A crop with a wide open mouth, and a row of teeth in it."""
    mesh = in_crop(opened(placed(70), 0.6))
    picture = painted(mesh, CROP_SHAPE[::-1])
    inner = mesh[list(LIPS_INNER), :2]
    mouth = np.zeros(CROP_SHAPE, np.uint8)
    cv2.fillPoly(mouth, [inner.round().astype(np.int32)], 1)
    top = int(inner[:, 1].min())
    mouth[: top + 6] = 0
    mouth[top + 22 :] = 0
    picture[mouth > 0] = TEETH
    return picture, mesh


@pytest.fixture(scope="module")
def neutral() -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    mesh = in_crop(placed(70))
    return painted(mesh, CROP_SHAPE[::-1]), mesh


@pytest.fixture(scope="module")
def palette(closed, neutral) -> MouthPalette:
    return match_palette(painted(closed, SIZE), closed, *neutral)


def warped(mesh: NDArray) -> NDArray[np.uint8]:
    """A target whose mouth was opened by the warp alone: lip colour where the inside should be."""
    picture = painted(mesh, SIZE)
    cv2.fillPoly(picture, [mesh[list(LIPS_INNER), :2].round().astype(np.int32)], (170, 90, 85))
    return picture


def area(mesh: NDArray) -> float:
    return float(cv2.contourArea(mesh[list(LIPS_INNER), :2].astype(np.float32)))


def with_area(closed: NDArray, wanted: float) -> NDArray[np.float32]:
    """The face opened so far that its mouth's inner area is `wanted` square pixels."""
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if area(opened(closed, middle)) < wanted else (low, middle)
    return opened(closed, low)


def inner_mask(mesh: NDArray, grow: int) -> NDArray[np.bool_]:
    mask = np.zeros((SIZE[1], SIZE[0]), np.uint8)
    cv2.fillPoly(mask, [mesh[list(LIPS_INNER), :2].round().astype(np.int32)], 1)
    kernel = np.ones((2 * abs(grow) + 1,) * 2, np.uint8)
    return np.asarray((cv2.dilate if grow > 0 else cv2.erode)(mask, kernel) > 0)


def change(mesh: NDArray, driver, palette: MouthPalette) -> NDArray[np.float64]:
    frame = warped(mesh)
    before = frame.copy()
    transfer_mouth(frame, mesh[:, :2], *driver, palette)
    return np.abs(frame.astype(float) - before)


def test_a_mouth_not_opener_than_the_picture_s_is_left_alone(closed, driver, palette) -> None:
    assert not change(closed, driver, palette).any()
    assert not change(with_area(closed, 0.98 * APPEARING_AREA * palette.area), driver, palette).any()


def test_the_inside_appears_between_once_and_twice_the_area(closed, driver, palette) -> None:
    """Linearly, from nothing to whole (section 5), and no more beyond."""
    mesh = opened(closed, 0.3)

    def seen(share: float) -> float:
        """Mean change inside the lips where the mouth's area is `share` times the neutral one's."""
        known = replace(palette, area=area(mesh) / share, gap=1e9)
        return float(change(mesh, driver, known)[inner_mask(mesh, -2)].mean())

    for share in (1.1, 1.25, 1.5, 1.75, 2.0, 2.6, 10.0):
        assert seen(share) / seen(FULL_AREA) == pytest.approx(min(share - APPEARING_AREA, 1), abs=0.03)


def test_lips_that_part_show_the_inside_though_the_mouth_grows_no_larger(closed, driver, palette) -> None:
    """A smile that becomes an O: half of the driver's mouth where its gap is half-way through the ramp."""
    mesh = opened(closed, 0.3)
    gap = float(np.linalg.norm(mesh[[82, 13, 312], :2] - mesh[[87, 14, 317], :2], axis=1).mean())

    def seen(share: float) -> float:
        known = replace(palette, area=1e9, gap=gap / share)
        return float(change(mesh, driver, known)[inner_mask(mesh, -2)].mean())

    assert seen(0.99 * APPEARING_GAP) == 0
    assert seen((APPEARING_GAP + FULL_GAP) / 2) / seen(FULL_GAP) == pytest.approx(0.5, abs=0.03)
    assert seen(10) == seen(FULL_GAP) > 0


def test_a_closed_mouth_s_area_has_a_floor(closed, palette) -> None:
    """So that the ramp of a mouth with no area at all is not over at once."""
    width = float(np.linalg.norm(closed[61, :2] - closed[291, :2]))
    assert palette.area >= MIN_INNER_AREA * width**2 * 0.999
    assert palette.area == pytest.approx(max(area(closed), MIN_INNER_AREA * width**2), rel=1e-3)


def test_only_the_inner_contour_is_touched(closed, driver, palette) -> None:
    """The lips are the target's own (section 5)."""
    mesh = opened(closed, 0.5)
    assert not change(mesh, driver, palette)[~inner_mask(mesh, 2)].any()


def test_teeth_arrive_where_the_driver_has_them(closed, driver, palette) -> None:
    """Between upper and lower lip at the same share of the opening; dark beneath."""
    mesh = opened(closed, 0.6)
    frame = warped(mesh)
    transfer_mouth(frame, mesh[:, :2], *driver, palette)
    x = int(mesh[13, 0])
    top, bottom = float(mesh[13, 1]), float(mesh[14, 1])
    crop, points = driver
    first, last = float(points[13, 1]), float(points[14, 1])
    for share in (0.2, 0.5, 0.8):
        y, v = round(top + share * (bottom - top)), round(first + share * (last - first))
        theirs = crop[v, int(points[13, 0])].astype(float).mean() > 150
        ours = frame[y, x].astype(float).mean() > 150
        assert ours == theirs
    assert frame[round(top + 0.7 * (bottom - top)), x].astype(float).mean() < np.mean(DARK) + 50


def test_a_grey_target_gets_a_grey_mouth(closed, driver, neutral) -> None:
    grey = cv2.cvtColor(cv2.cvtColor(painted(closed, SIZE), cv2.COLOR_RGB2GRAY), cv2.COLOR_GRAY2RGB)
    palette = match_palette(grey, closed, *neutral)
    mesh = opened(closed, 0.5)
    frame = cv2.cvtColor(cv2.cvtColor(warped(mesh), cv2.COLOR_RGB2GRAY), cv2.COLOR_GRAY2RGB)
    before = frame.copy()
    transfer_mouth(frame, mesh[:, :2], *driver, palette)
    assert np.abs(frame.astype(int) - before).max() > 50
    assert np.ptp(frame.astype(int), axis=2).max() <= 1


def test_a_sepia_target_gets_a_sepia_mouth(closed, driver, neutral) -> None:
    tint = np.array([1.1, 0.95, 0.7])
    grey = cv2.cvtColor(painted(closed, SIZE), cv2.COLOR_RGB2GRAY)[..., None]
    sepia = np.clip(grey * tint, 0, 255).astype(np.uint8)
    palette = match_palette(sepia, closed, *neutral)
    colours = relight(driver[0], palette)
    light = colours.mean(axis=2, keepdims=True)
    ratio = (colours / np.maximum(light, 1))[light[..., 0] > 40]
    np.testing.assert_allclose(ratio, np.broadcast_to(tint / tint.mean(), ratio.shape), atol=0.03)


def test_light_is_the_target_s(closed, driver, neutral) -> None:
    """In a picture half as bright teeth are half as bright."""
    bright = match_palette(painted(closed, SIZE), closed, *neutral)
    dim = match_palette(painted(closed, SIZE) // 2, closed, *neutral)
    assert relight(driver[0], dim).mean() == pytest.approx(relight(driver[0], bright).mean() / 2, rel=0.05)


def test_between_the_same_two_faces_colours_stay(closed, neutral) -> None:
    palette = match_palette(painted(closed, SIZE), closed, *neutral)
    lit = relight(neutral[0], palette)
    assert np.abs(lit - neutral[0]).mean() < 4


def test_triangles_cover_the_mouth_once(closed) -> None:
    points = opened(closed, 0.5)[list(LIPS_OUTER + LIPS_INNER), :2].astype(float)
    a, b, c = (points[mouth_triangles()[:, k]] for k in range(3))
    areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    whole = cv2.contourArea(points[:20].astype(np.float32))
    assert np.abs(areas).sum() == pytest.approx(whole, rel=0.02)


def test_a_mouth_at_or_beyond_the_border_does_no_harm(closed, driver, palette) -> None:
    for shift in ((0, 180), (-190, 0), (0, 400), (170, 150)):
        mesh = opened(closed, 0.5)
        mesh[:, :2] += shift
        frame = painted(closed, SIZE)
        transfer_mouth(frame, mesh[:, :2], *driver, palette)


@pytest.mark.parametrize("skin", [(235, 215, 220), (200, 170, 80), (90, 60, 45)], ids=["rosy", "varnished", "dark"])
def test_teeth_never_turn_green(closed, driver, neutral, skin) -> None:
    """Whatever the two skins and lips differ by: a tooth keeps a tooth's colour, a little of the light at most."""
    picture = painted(closed, SIZE)
    picture[(picture == SKIN).all(axis=2)] = skin
    palette = match_palette(picture, closed, *neutral)
    mesh = opened(closed, 0.6)
    frame = np.where((warped(mesh) == (170, 90, 85)).all(axis=2)[..., None], np.uint8([105, 108, 106]), warped(mesh))
    frame = np.ascontiguousarray(frame, np.uint8)
    transfer_mouth(frame, mesh[:, :2], *driver, palette)
    inside = frame[inner_mask(mesh, -3)].astype(float)
    teeth = inside[inside.sum(axis=1) > np.quantile(inside.sum(axis=1), 0.8)]
    red, green, blue = teeth.mean(axis=0)
    assert green <= 1.08 * red, (red, green, blue)
