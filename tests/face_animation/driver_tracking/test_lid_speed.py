"""Blinks take the time that people's take, and are shut when they were."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed, shut

from engine.face_animation.driver_tracking.lid_speed import FALLS_SECONDS, RISES_SECONDS, held_openness, slow_lids
from engine.face_animation.motion_transfer.lids_and_lips import (
    LID_EDGE_VERTEX_PAIRS,
    LID_SKIN_VERTEX_PAIRS,
    lid_ratio,
)
from engine.face_animation.motion_transfer.usual_lids import SHUT_SHARE


@pytest.mark.parametrize("fps", [24.0, 30.0, 60.0])
def test_a_blink_of_one_frame_falls_and_rises_as_a_lid_does(fps: float) -> None:
    seen = np.ones((80, 1))
    seen[40] = SHUT_SHARE
    held = held_openness(seen, 0, fps)[:, 0]
    assert held[40] == pytest.approx(SHUT_SHARE)
    moving = np.flatnonzero(held < 1 - 1e-9)
    assert 40 - moving[0] == pytest.approx(FALLS_SECONDS * fps, abs=1)
    assert moving[-1] - 40 == pytest.approx(RISES_SECONDS * fps, abs=1)
    assert (np.diff(held[moving[0] : 41]) < 0).all()
    assert (np.diff(held[40 : moving[-1]]) > 0).all()


def test_what_is_slow_enough_stays_as_it_is() -> None:
    slow = 1 - 0.4 * np.sin(np.linspace(0, np.pi, 60))[:, None] ** 2
    np.testing.assert_allclose(held_openness(slow, 0, 25.0), slow)
    wide = np.where(np.arange(60) < 30, 1.4, 1.0)[:, None]
    np.testing.assert_allclose(held_openness(wide, 0, 25.0), wide, err_msg="eyes that were wide may narrow at once")


@pytest.mark.parametrize("away", [-3, -1, 1, 3])
def test_the_frame_that_all_are_measured_by_stays_though_a_blink_is_beside_it(away: int) -> None:
    seen = np.ones((80, 1))
    seen[40] = SHUT_SHARE
    held = held_openness(seen, 40 + away, 30.0)[:, 0]
    assert held[40 + away] == 1 and held[40] == pytest.approx(SHUT_SHARE)
    beyond = np.flatnonzero(held < 1 - 1e-9)
    assert beyond[-1] > 43 or beyond[0] < 38, "on the other side the lid takes its time"


@pytest.mark.parametrize("away", [-3, 6])
def test_a_blink_that_is_far_enough_from_that_frame_is_as_slow_as_any(away: int) -> None:
    """At 30 frames a second a lid falls in 3 of them, and rises in 6."""
    seen = np.ones((80, 1))
    seen[40] = SHUT_SHARE
    held = held_openness(seen, 40 + away, 30.0)[:, 0]
    assert held[40 + away] == 1 and held[40] == pytest.approx(SHUT_SHARE)
    steps = np.diff(held) * 30.0 / (1 - SHUT_SHARE)
    assert steps.min() > -1 / FALLS_SECONDS - 1e-9
    assert steps.max() < 1 / RISES_SECONDS + 1e-9


def test_lids_of_meshes_go_down_earlier_and_up_later_and_nothing_else_moves() -> None:
    face = placed(60)
    meshes = np.repeat(face[None], 20, axis=0)
    meshes[10] = shut(face, 0.2)
    before = meshes.copy()
    slow_lids(meshes, 0, 30.0)
    open_by = lid_ratio(meshes, face)[:, 3]
    assert open_by[10] == 0
    assert (np.diff(open_by[7:11]) < 0).all()
    assert (np.diff(open_by[10:15]) >= 0).all()
    np.testing.assert_array_equal(open_by[:7], 1)
    skin, lid = np.array(LID_SKIN_VERTEX_PAIRS)[:, 0], np.array(LID_EDGE_VERTEX_PAIRS)[:, 0]
    moved = meshes - before
    assert np.abs(moved[9, lid]).max() > 0
    np.testing.assert_allclose(moved[:, skin], 0.5 * moved[:, lid], atol=1e-3, err_msg="the skin goes half the way")
    np.testing.assert_allclose(meshes[:, [1, 13, 14, 152, 145, 374]], before[:, [1, 13, 14, 152, 145, 374]])
