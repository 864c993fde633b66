"""A head before the camera goes no further than its picture can hold; little motions stay as they are."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarities
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import RIGID_VERTICES
from engine.portrait.live.kept_in_frame import MAX_SCALE, kept_in_frame

UNIT = 60.0
REST = canonical_face().astype(float) * UNIT + (320, 240, 0)
REACH = np.array([0.9, 0.5])
RIGID = list(RIGID_VERTICES)


def moved(shift: tuple[float, float] = (0, 0), scale: float = 1.0, yaw: float = 0.0) -> NDArray[np.float64]:
    turn = np.asarray(cv2.Rodrigues(np.array([0, np.deg2rad(yaw), 0.0]))[0])
    middle = REST[RIGID].mean(axis=0)
    return np.asarray(scale * (REST - middle) @ turn.T + middle + UNIT * np.array([*shift, 0]), float)


def way(mesh: NDArray[np.floating]) -> NDArray[np.floating]:
    """How far the head's middle has gone, eye distances."""
    return (mesh[RIGID].mean(axis=0) - REST[RIGID].mean(axis=0))[:2] / UNIT


def test_at_rest_and_turned_it_is_where_it_was() -> None:
    for mesh in (REST, moved(yaw=20)):
        np.testing.assert_allclose(kept_in_frame(mesh, REST, REACH), mesh, atol=0.05)


def test_little_ways_are_gone_whole_and_none_is_longer_than_the_reach() -> None:
    np.testing.assert_allclose(way(kept_in_frame(moved((0.1, 0.05)), REST, REACH)), (0.1, 0.05), rtol=0.02)
    ways = np.array([way(kept_in_frame(moved((x, x)), REST, REACH)) for x in np.linspace(-4, 4, 33)])
    assert (np.diff(ways, axis=0) > -1e-5).all()
    assert (abs(ways) <= REACH + 1e-5).all()


def test_who_leans_in_grows_by_no_more_than_may_be_and_keeps_their_face() -> None:
    kept = kept_in_frame(moved(scale=3.0, yaw=15), REST, REACH)
    scale, rotation, _ = fit_similarities(REST[RIGID], kept[None, RIGID], np.ones(len(RIGID)))
    assert 1.2 < scale[0] <= MAX_SCALE
    np.testing.assert_allclose(np.rad2deg(np.arccos(rotation[0, 2, 2])), 15, atol=0.1)
