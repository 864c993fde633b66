"""Cloth that hangs goes with the legs as far as it takes to stay around them: a stride of two straight legs, whose cloth is known."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.parts import BODY_PARTS
from engine.character.fit.template_fit import load_human
from engine.character.parts.free_cloth import FreeCloth, free_cloth
from engine.character.surface.drape import drape
from engine.character.surface.front_and_back import Layer
from engine.character.surface.part_surface import Surface
from engine.character.surface.skirt_weights import HIPS_ABOVE_CROTCH_FACTOR, STRIDE_DEGREES, following, moved_by_both

HIGH, WIDE, MIDDLE, WAIST, CROTCH, HEM, DEEP, LEG = 400, 240, 120, 150, 190, 290, 16.0, 20
RIG = load_human().rig
JOINTS = [RIG.index(name) for name in ("Hips", "LeftUpLeg", "RightUpLeg")]


def dressed(flare: float, seat: float = DEEP) -> tuple[Layer, Layer, FreeCloth]:
    """A body in a skirt that widens by `flare` pixels a row to each side: as it is bare, draped and moved, and its cloth. Its hips are
    as deep as their `seat`, to each side."""
    shown = np.full((HIGH, WIDE), -1)
    shown[60 : CROTCH + 1, MIDDLE - 24 : MIDDLE + 24] = BODY_PARTS.index("torso")
    shown[CROTCH + 1 : 390, MIDDLE - 4 - LEG : MIDDLE - 4] = BODY_PARTS.index("right_leg")
    shown[CROTCH + 1 : 390, MIDDLE + 4 : MIDDLE + 4 + LEG] = BODY_PARTS.index("left_leg")
    mask = shown >= 0
    for row in range(WAIST, HEM + 1):
        half = 26 + round(flare * (row - WAIST))
        mask[row, MIDDLE - half : MIDDLE + half] = True
    depth = np.where(shown >= 0, DEEP, np.nan)
    cloth = free_cloth(mask, shown, depth, -depth, np.zeros_like(mask), hem=HEM)
    assert cloth is not None and cloth.hangs
    weights = np.zeros((HIGH, WIDE, len(RIG.names)), np.float32)
    weights[:CROTCH, :, JOINTS[0]] = 1
    weights[CROTCH:, MIDDLE:, JOINTS[1]] = 1
    weights[CROTCH:, :MIDDLE, JOINTS[2]] = 1
    thick = np.where(np.arange(HIGH)[:, None] < CROTCH, seat, DEEP)
    bare = Layer(mask, *(Surface(np.where(mask, z * thick, np.nan).astype(np.float32), weights) for z in (1, -1)))
    draped = drape(bare, cloth)
    return bare, moved_by_both(draped, cloth, RIG, bare), cloth


def strode(points: np.ndarray, weights: np.ndarray, hips: float, degrees: float) -> np.ndarray:
    """Points (n, 3), x right, y down, z ahead, moved by weights (n, 3) of hips, left and right thigh: the left swings forward about the
    row of the hips, the right back."""
    moved = weights[:, :1] * points
    for k, turn in ((1, degrees), (2, -degrees)):
        c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
        y, z = points[:, 1] - hips, points[:, 2]
        moved += weights[:, k : k + 1] * np.stack([points[:, 0], hips + c * y - s * z, s * y + c * z], 1)
    return moved


def ring(body: Layer, row: int) -> tuple[np.ndarray, np.ndarray]:
    """A row of cloth all round, front and back: points (n, 3) and their weights (n, 3)."""
    columns = np.flatnonzero(body.mask[row])
    around = [(body.front, columns), (body.back, columns[::-1])]
    points = [np.stack([at, np.full(len(at), row), side.depth[row, at]], 1) for side, at in around]
    return np.concatenate(points), np.concatenate([side.weights[row, at][:, JOINTS] for side, at in around])


@pytest.mark.parametrize("flare", [0.05, 0.2, 0.4])
def test_no_leg_comes_through(flare: float) -> None:
    _, body, cloth = dressed(flare)
    hips = CROTCH - HIPS_ABOVE_CROTCH_FACTOR * cloth.even
    for row in (HEM - 40, HEM - 5):
        points, weights = ring(body, row)
        np.testing.assert_allclose(weights.sum(1), 1, atol=1e-5)
        moved = strode(points, weights, hips, STRIDE_DEGREES)
        for middle, ahead in ((MIDDLE + 4 + LEG / 2, 1), (MIDDLE - 4 - LEG / 2, -1)):
            beside = abs(moved[:, 0] - middle) < LEG / 4
            reach = (row - hips) * np.sin(np.radians(STRIDE_DEGREES)) + DEEP * np.cos(np.radians(STRIDE_DEGREES))
            assert (ahead * moved[beside, 2]).max() > 0.82 * reach, "but for what its middle gives way"


@pytest.mark.parametrize("flare", [0.05, 0.2, 0.4])
def test_what_moves_cloth_is_continuous_around_it(flare: float) -> None:
    _, body, _ = dressed(flare)
    for row in (CROTCH + 10, HEM - 40, HEM - 5):
        weights = ring(body, row)[1]
        step = np.abs(np.roll(weights, -1, 0) - weights).max()
        assert step < 0.16, "and closes at both sides, where front and back are one"
    down = body.front.weights[CROTCH - 20 : HEM, MIDDLE - 20 : MIDDLE + 20][..., JOINTS]
    assert np.abs(np.diff(down, axis=0)).max() < 0.12


def test_a_wide_hem_keeps_its_length() -> None:
    _, body, cloth = dressed(0.4)
    points, weights = ring(body, HEM - 5)
    moved = strode(points, weights, CROTCH - HIPS_ABOVE_CROTCH_FACTOR * cloth.even, STRIDE_DEGREES)
    before, after = (np.linalg.norm(np.roll(at, -1, 0) - at, axis=1).sum() for at in (points, moved))
    assert after == pytest.approx(before, rel=0.2)


def test_what_stands_off_need_not_go_along() -> None:
    shares = []
    for flare in (0.05, 0.2, 0.4):
        bare, body, cloth = dressed(flare)
        shares.append(following(body, bare, cloth)[-10].mean())
    assert shares[0] > 0.85 and shares[2] < 0.5 and shares[0] > shares[1] > shares[2]


def test_a_straight_skirt_falls_from_the_seat_and_a_bell_does_not() -> None:
    for seat in (DEEP, DEEP + 8):
        _, straight, _ = dressed(0.0, seat)
        thick = (straight.front.depth - straight.back.depth)[HEM - 30 : HEM, MIDDLE - 4 : MIDDLE + 4] / 2
        np.testing.assert_allclose(thick, seat, atol=0.6)
    _, bell, _ = dressed(0.4)
    assert (bell.front.depth - bell.back.depth)[HEM - 10, MIDDLE] / 2 > 2.5 * DEEP
