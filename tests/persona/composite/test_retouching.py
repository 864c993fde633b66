"""The persona's creases on a photograph's frame."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import FACE_OVAL, LEFT_BROW, LEFT_EYE, LIPS_OUTER, RIGHT_BROW, RIGHT_EYE
from engine.persona.composite.regions import retouched_skin
from engine.persona.composite.retouching import Retouching
from engine.persona.light.low_frequencies import low_frequencies
from engine.persona.texture.texture_frame import TextureFrame, texture_frame

SIZE = (244, 194)


@pytest.fixture(scope="module")
def frame() -> TextureFrame:
    return texture_frame(canonical_face().astype(float), SIZE)


def made(frame: TextureFrame, **changed: object) -> Retouching:
    base = np.full((*SIZE, 3), 140, np.uint8)
    given = {"skin": retouched_skin(frame), "contrast": 1.0, "unresolved": 0.0, "grey": False, **changed}
    return Retouching(frame, base, **given)  # type: ignore[arg-type]


def drawn(retouching: Retouching, texture: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A random picture, the same retouched, and the face's places in it."""
    face = retouching.frame.places[:478].copy() * 1.5 + (20, 15, 0)
    before = np.random.default_rng(0).integers(60, 190, (420, 340, 3)).astype(np.uint8)
    after = before.copy()
    retouching(after, face[:, :2].astype(np.float32), face[:, 2].astype(np.float32), texture)
    return before, after, face


def mask(face: np.ndarray, contour: tuple[int, ...], shape: tuple[int, int]) -> np.ndarray:
    out = np.zeros(shape, np.uint8)
    cv2.fillPoly(out, [np.rint(face[list(contour), :2]).astype(np.int32)], 1)
    return out


def wrinkled(period: float) -> np.ndarray:
    wave = 140 + 20 * np.sin(2 * np.pi * np.arange(SIZE[0]) / period)
    return np.rint(np.repeat(np.repeat(wave[:, None], SIZE[1], 1)[..., None], 3, 2)).astype(np.uint8)


def test_at_the_photograph_s_own_expression_it_changes_nothing(frame: TextureFrame) -> None:
    retouching = made(frame)
    before, after, _ = drawn(retouching, retouching.base)
    np.testing.assert_array_equal(after, before)


def test_creases_come_onto_skin_and_nowhere_else(frame: TextureFrame) -> None:
    before, after, face = drawn(made(frame), wrinkled(8))
    changed = np.abs(after.astype(int) - before).max(axis=-1)
    shape = before.shape[:2]
    oval = mask(face, FACE_OVAL, shape)
    assert changed[oval == 0].max() == 0, "nothing beside the face"
    rim = oval - cv2.erode(oval, np.ones((9, 9), np.uint8))
    assert changed[rim > 0].max() <= 4, "no edge at its rim"
    for contour in (LEFT_EYE, RIGHT_EYE, LIPS_OUTER):
        inner = cv2.erode(mask(face, contour, shape), np.ones((3, 3), np.uint8))
        assert changed[inner > 0].max() <= 1
    nose = cv2.convexHull(np.rint(face[[168, 193, 417, 98, 327], :2]).astype(np.int32))
    bridge = cv2.fillConvexPoly(np.zeros(shape, np.uint8), nose, 1)
    assert changed[cv2.erode(bridge, np.ones((3, 3), np.uint8)) > 0].max() <= 1, (
        "its light and shade are the photograph's"
    )
    for brow in (LEFT_BROW, RIGHT_BROW):  # its hairs are a pixel elsewhere in each photograph
        x, y = np.rint(face[list(brow), :2].mean(axis=0)).astype(int)
        assert changed[y - 3 : y + 4, x - 12 : x + 13].max() <= 1
    cheek = np.rint(face[50, :2]).astype(int)
    assert changed[cheek[1] - 15 : cheek[1] + 15, cheek[0] - 8 : cheek[0] + 8].max() > 14


def test_light_is_left_as_it_is(frame: TextureFrame) -> None:
    slope = np.linspace(100, 180, SIZE[1])[None, :, None] + np.zeros((*SIZE, 3))
    layer = made(frame).layer(slope.astype(np.uint8))
    inside = retouched_skin(frame) > 0.9
    assert np.abs(layer[inside]).mean() < 4 < np.abs(slope[inside] - 140).mean()


def test_of_a_black_and_white_photograph_it_makes_no_coloured_one(frame: TextureFrame) -> None:
    texture = wrinkled(8)
    texture[..., 2] = 140
    layer = made(frame, grey=True).layer(texture)
    assert np.ptp(layer, axis=-1).max() == 0 < np.abs(layer).max()


def test_what_small_photographs_cannot_show_is_added(frame: TextureFrame) -> None:
    coarse, fine = (made(frame, unresolved=1.0).layer(wrinkled(period)) for period in (40, 3))
    shown = [made(frame).layer(wrinkled(period)) for period in (40, 3)]
    inside = retouched_skin(frame) > 0.9
    gains = [np.abs(a[inside]).mean() / np.abs(b[inside]).mean() for a, b in ((coarse, shown[0]), (fine, shown[1]))]
    assert gains[0] < 1.1 and gains[1] > 1.7


def test_low_frequencies_of_a_constant_are_it_wherever_is_told() -> None:
    random = np.random.default_rng(1)
    told = (random.random(SIZE) > 0.7).astype(np.float32)
    found = low_frequencies(np.full((*SIZE, 3), 77.0, np.float32), told, 67.0)
    np.testing.assert_allclose(found, 77, atol=0.01)
