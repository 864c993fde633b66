"""A face's jitter is taken out on its head: a head that shakes keeps its motion, and its lids and lips theirs."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import MESH_SIZE
from engine.perception.face_track.steady_face import HeadFrames, steady_face, steady_on_head, steady_points

SIGMA = 0.4
"""Of a tracker's jitter, pixels."""
FRAMES = 80
LID, LIP = 159, 14


def face() -> NDArray[np.float32]:
    """A face of 100 pixels between the eyes' outer corners, the picture's way up."""
    shape = canonical_face()
    return shape * np.float32(100 / np.linalg.norm(shape[33] - shape[263])) + np.float32(200)


def shaken(acted: NDArray[np.floating], seed: int = 1) -> NDArray[np.float32]:
    """Faces (N, 478, 3) on a head that is elsewhere, and otherwise turned, in every frame: by 5 pixels and 3 degrees."""
    rng, middle = np.random.default_rng(seed), acted[0].mean(axis=0)
    turns = [cv2.Rodrigues(np.deg2rad(rng.normal(0, 3, 3)))[0] for _ in acted]
    return np.asarray(
        [(one - middle) @ turn.T + middle + rng.normal(0, 5, 3) for one, turn in zip(acted, turns, strict=True)],
        np.float32,
    )


def acting() -> NDArray[np.float64]:
    """(N, 478, 3) a face that blinks in three frames and holds its mouth open in ten."""
    acted = np.repeat(face()[None].astype(float), FRAMES, axis=0)
    acted[39:42, LID, 1] += (7.0, 10.0, 7.0)
    acted[60:70, LIP, 1] += 12
    return acted


def seen(truth: NDArray[np.floating], seed: int = 2) -> NDArray[np.float32]:
    """Faces as a tracker sees them, with jitter in every vertex."""
    return np.asarray(truth + np.random.default_rng(seed).normal(0, SIGMA, truth.shape), np.float32)


def test_a_head_that_shakes_is_where_it_was_seen() -> None:
    truth = shaken(acting())
    np.testing.assert_allclose(steady_face(truth), truth, atol=0.05)


def test_jitter_goes_also_where_the_head_shakes() -> None:
    """Of what a still face has two fifths go at least, on the head; and blink and mouth keep their height and their moment."""
    truth = shaken(acting())
    found, meshes = steady_face(seen(truth)), seen(truth)
    frames = HeadFrames.of(truth)
    on_head, before = frames.on_head(found), frames.on_head(meshes)
    still = np.delete(np.arange(MESH_SIZE), [LID, LIP])
    own = on_head[:, still] - on_head[:, still].mean(axis=1, keepdims=True)
    raw = before[:, still] - before[:, still].mean(axis=1, keepdims=True)
    assert own.std(axis=0).mean() < 0.6 * raw.std(axis=0).mean()
    lid = on_head[:, LID, 1] - np.median(on_head[:, LID, 1])
    assert int(lid.argmax()) == 40 and lid[40] == pytest.approx(10, abs=1.5)
    lip = on_head[:, LIP, 1] - np.median(on_head[:, LIP, 1])
    assert lip[60:70].mean() == pytest.approx(12, abs=0.5) and np.abs(lip[[58, 71]]).max() < 1


def test_a_face_at_rest_loses_two_thirds_of_its_jitter() -> None:
    meshes = seen(np.repeat(face()[None], FRAMES, axis=0))
    assert steady_face(meshes)[10:-10].std(axis=0).mean() < meshes.std(axis=0).mean() / 3


def test_some_vertices_are_steadied_on_their_head_and_the_others_stay() -> None:
    truth = shaken(acting())
    meshes, some = seen(truth), np.array([50, LIP, 280])
    before, others = meshes.copy(), np.delete(np.arange(MESH_SIZE), some)
    steady_on_head(meshes, some)
    np.testing.assert_array_equal(meshes[:, others], before[:, others])
    np.testing.assert_array_equal(meshes[..., 2], before[..., 2])
    frames = HeadFrames.of(truth)
    apart, raw = (frames.on_head(one)[:, some] - frames.on_head(truth)[:, some] for one in (meshes, before))
    assert apart.std() < 0.75 * raw.std()


def test_the_result_goes_where_it_is_wanted() -> None:
    meshes = seen(shaken(acting()))
    expected = steady_face(meshes)
    assert steady_face(meshes, out=meshes) is meshes
    np.testing.assert_allclose(meshes, expected, atol=1e-4)


def test_to_the_head_and_back_is_where_it_was() -> None:
    truth = shaken(acting())
    frames = HeadFrames.of(truth)
    np.testing.assert_allclose(frames.in_video(frames.on_head(truth)), truth, atol=1e-3)
    still = np.delete(np.arange(MESH_SIZE), [LID, LIP])
    np.testing.assert_allclose(frames.on_head(truth)[:, still], np.repeat(truth[:1, still], FRAMES, axis=0), atol=1e-2)


def test_points_on_the_head_and_on_the_wall_are_where_they_were_seen() -> None:
    rng = np.random.default_rng(3)
    still = np.repeat(face()[None].astype(float), FRAMES, axis=0)
    meshes = np.asarray(still + rng.normal(0, 5, (FRAMES, 1, 3)), np.float32)
    hair, wall = meshes[:, :5, :2] - (0, 90), np.full((FRAMES, 5, 2), 40.0)
    points = np.concatenate([hair, wall], axis=1).astype(np.float32)
    np.testing.assert_allclose(steady_points(points, meshes), points, atol=0.05)
