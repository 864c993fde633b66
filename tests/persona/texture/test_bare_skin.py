"""Hair that falls over a face is told from its skin, and the skin is continued beneath it."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.persona.texture.aligned_photos import AlignedPhotos, align_photos
from engine.persona.texture.bare_skin import BareSkin, bared
from engine.persona.texture.template_shape import template_shape
from engine.persona.texture.texture_frame import TextureFrame, texture_frame

SIZE = (244, 194)
Collection = tuple[np.ndarray, list[np.ndarray]]


@pytest.fixture(scope="module")
def frame(collection: Collection) -> TextureFrame:
    return texture_frame(template_shape(collection[0]), SIZE)


@pytest.fixture(scope="module")
def laid(collection: Collection, frame: TextureFrame) -> AlignedPhotos:
    meshes, photos = collection
    some = range(0, len(photos), 4)
    return align_photos(frame, [meshes[k] for k in some], lambda k: photos[some[k]])


def fringe(frame: TextureFrame) -> np.ndarray:
    """(H, W) which hangs into the left half of the forehead from above."""
    rows, columns = np.indices(SIZE)
    brow, middle = frame.places[105, 1], frame.places[9, 0]
    slope = (columns - frame.places[127, 0]) / (middle - frame.places[127, 0])
    return np.asarray((rows < brow - 3 - 8 * np.maximum(slope, 0)) & (columns < middle))


def haired(photo: np.ndarray, where: np.ndarray, seed: int) -> np.ndarray:
    """With strands of a blond there."""
    strands = cv2.GaussianBlur(np.random.default_rng(seed).normal(size=SIZE), (0, 0), sigmaX=1, sigmaY=9)
    hair = np.array([205, 170, 95]) * (1 + 0.2 * strands / strands.std())[..., None]
    return np.where(where[..., None], np.clip(hair, 0, 255), photo).astype(np.uint8)


def detail(photo: np.ndarray, where: np.ndarray) -> float:
    return float(np.abs(photo - cv2.GaussianBlur(photo.astype(np.float32), (0, 0), 2))[where].mean())


def test_the_middle_of_faces_is_bare(frame: TextureFrame, laid: AlignedPhotos) -> None:
    found = BareSkin(frame)(laid.colours)
    assert found[:, ~frame.face].max() < 1e-6, "hair and neck beside the oval are not the face's"
    inner = cv2.erode(frame.face.astype(np.uint8), np.ones((61, 61))) > 0
    assert found[:, inner].mean() > 0.98


def test_a_fringe_is_told(frame: TextureFrame, laid: AlignedPhotos) -> None:
    where = fringe(frame)
    within = where & (cv2.erode(frame.face.astype(np.uint8), np.ones((5, 5))) > 0)
    assert within.sum() > 400
    tell = BareSkin(frame)
    for seed, photo in enumerate(laid.colours):
        before, after = tell.of(photo), tell.of(haired(photo, where, seed))
        assert after[within].mean() < 0.1
        away = frame.face & (cv2.dilate(where.astype(np.uint8), np.ones((25, 25))) == 0)
        assert after[away].mean() > before[away].mean() - 0.03, "and costs nothing elsewhere"


def test_beneath_a_fringe_there_is_skin(frame: TextureFrame, laid: AlignedPhotos) -> None:
    where = fringe(frame)
    covered = np.array([haired(photo, where, seed) for seed, photo in enumerate(laid.colours)])
    plain, found = bared(frame, laid), bared(frame, AlignedPhotos(covered, laid.shown))
    within = where & frame.face
    off, before = (
        np.abs(one[:, within].astype(float) - plain.colours[:, within]).mean() for one in (found.colours, covered)
    )
    assert off < 0.6 * before, "grey levels: in the skin's own shades"
    strands, left = (np.mean([detail(photo, within) for photo in one]) for one in (covered, found.colours))
    assert left < 0.06 * strands
    assert found.shown[:, within].mean() < 0.1
    away = frame.face & (cv2.dilate(where.astype(np.uint8), np.ones((25, 25))) == 0)
    same = (found.shown > 0.5) & (plain.shown > 0.5) & away
    assert (found.colours == laid.colours)[same].all(), "what is bare stays as it is"
