"""What moves a piece that is worn: the skin below it, and on a head the head alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.influences import influences

SIDE = 11
SPINE, HEAD, JAW = range(3)


@pytest.fixture(scope="module")
def skin() -> tuple[BodySurface, np.ndarray]:
    """A wall of a metre's side, and the weights of its vertices: the upper half is moved by the head, and a tenth by the jaw."""
    y, x = np.divmod(np.arange(SIDE * SIDE), SIDE)
    vertices = np.stack([x, y, 0 * x], 1) / (SIDE - 1)
    corner = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)[:-1, :-1].ravel()
    triangles = np.concatenate([corner[:, None] + [0, 1, SIDE], corner[:, None] + [1, SIDE + 1, SIDE]]).astype(np.int32)
    upper = (vertices[:, 1] > 0.5).astype(float)
    none = np.zeros(len(vertices), np.bool_)
    return BodySurface(vertices, triangles, none, none, none), np.stack([1 - upper, 0.9 * upper, 0.1 * upper], 1)


@pytest.mark.parametrize(("low", "joints"), [(0.3, {HEAD}), (-0.2, {SPINE, HEAD, JAW})])
def test_a_piece_that_lies_mostly_on_the_head_turns_with_it_as_a_whole(
    skin: tuple[BodySurface, np.ndarray], low: float, joints: set[int]
) -> None:
    """A strip of 0.8 metres, that far above the ground; both reach over the border."""
    body, weights = skin
    y = low + np.linspace(0, 0.8, 9)
    vertices = np.concatenate([np.stack([np.full(9, x), y, np.full(9, 0.02)], 1) for x in (0.4, 0.5)])
    first = np.arange(8)
    triangles = np.concatenate([first[:, None] + [0, 9, 1], first[:, None] + [9, 10, 1]]).astype(np.int32)
    found, shares = influences(vertices, triangles, body, weights, np.array([False, True, True]))
    np.testing.assert_allclose(shares.sum(1), 1, atol=1e-6)
    assert set(found[shares > 0]) == joints


def test_what_hangs_beside_an_arm_is_not_moved_by_it(skin: tuple[BodySurface, np.ndarray]) -> None:
    """The wall's upper half is an arm: what lies on it, and nearest to it, goes with the lower half."""
    body, weights = skin
    upper = body.vertices[:, 1] > 0.5
    vertices = np.array([[0.4, 0.7, 0.02], [0.5, 0.7, 0.02], [0.4, 0.9, 0.02]])
    arm = replace(body, own=upper)
    none = np.zeros(3, np.bool_)
    found, shares = influences(vertices, np.array([[0, 1, 2]], np.int32), arm, weights, none)
    assert set(found[shares > 0]) == {SPINE}


def test_what_reaches_over_a_border_of_the_skin_is_bent_and_not_folded(skin: tuple[BodySurface, np.ndarray]) -> None:
    """A strip of 0.8 metres, half of it over each of two joints' skin."""
    body, weights = skin
    y = 0.1 + np.linspace(0, 0.8, 9)
    vertices = np.concatenate([np.stack([np.full(9, x), y, np.full(9, 0.02)], 1) for x in (0.4, 0.5)])
    first = np.arange(8)
    triangles = np.concatenate([first[:, None] + [0, 9, 1], first[:, None] + [9, 10, 1]]).astype(np.int32)
    found, shares = influences(vertices, triangles, body, weights, np.zeros(3, np.bool_))
    lower = np.where(found[:9] == SPINE, shares[:9], 0).sum(1)
    assert (np.diff(lower) < 0).all() and np.abs(np.diff(lower)).max() < 0.3


def test_the_strongest_four_of_many_joints_move_it_whole(skin: tuple[BodySurface, np.ndarray]) -> None:
    body, _ = skin
    weights = np.tile([0.3, 0.25, 0.2, 0.15, 0.1], (len(body.vertices), 1))
    vertices = np.array([[0.4, 0.7, 0.02], [0.5, 0.7, 0.02], [0.4, 0.9, 0.02]])
    found, shares = influences(vertices, np.array([[0, 1, 2]], np.int32), body, weights, np.zeros(5, np.bool_))
    np.testing.assert_array_equal(found, [[0, 1, 2, 3]] * 3)
    np.testing.assert_allclose(shares, [np.array([0.3, 0.25, 0.2, 0.15]) / 0.9] * 3, atol=1e-6)
