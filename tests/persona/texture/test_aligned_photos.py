"""Faces of photographs in one frame."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LIPS_INNER, mouth_opening
from engine.persona.texture.aligned_photos import align_photos
from engine.persona.texture.template_shape import TEMPLATE_MOUTH_OPENING, template_shape
from engine.persona.texture.texture_frame import TextureFrame, texture_frame

SIZE = (122, 97)


@pytest.fixture(scope="module")
def frame() -> TextureFrame:
    return texture_frame(canonical_face(), SIZE)


def photographed(frame: TextureFrame, degrees: float, scale: float = 2.0) -> np.ndarray:
    """The mesh (478, 3) of the frame's face in a photograph of 400 x 400 in which its head is turned."""
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    face = frame.places[:478] - frame.places[:478].mean(axis=0)
    return scale * face @ turn.T + [200, 200, 0]


def painted(mesh: np.ndarray, frame: TextureFrame) -> np.ndarray:
    """A photograph (400, 400, 3) of that mesh: red on the picture's left half of the face, blue on the right."""
    photo = np.zeros((400, 400, 3), np.uint8)
    left = frame.places[:478, 0] < (SIZE[1] - 1) / 2
    for triangle in frame.triangles[(frame.triangles < 478).all(axis=1)]:
        colour = (255, 0, 0) if left[triangle].sum() >= 2 else (0, 0, 255)
        cv2.fillConvexPoly(photo, np.rint(mesh[triangle, :2]).astype(np.int32), colour)
    return photo


def test_faces_from_before_and_from_the_side_look_alike_in_the_frame(frame: TextureFrame) -> None:
    meshes = [photographed(frame, degrees) for degrees in (0, 20, -20)]
    photos = [painted(mesh, frame) for mesh in meshes]
    aligned = align_photos(frame, meshes, lambda k: photos[k])
    assert len(aligned) == 3 and aligned.colours.dtype == np.uint8
    quarter = SIZE[1] // 4
    middle = SIZE[0] // 2
    for colours in aligned.colours[:1]:
        assert colours[middle, quarter, 0] > 200 and colours[middle, -quarter, 2] > 200
    both = (aligned.shown[1:] > 0.9).all(axis=0) & frame.face
    assert both.sum() > 1000
    assert np.abs(aligned.colours[1].astype(int) - aligned.colours[0])[both].mean() < 12, (
        "grey levels, edges among them"
    )
    assert (aligned.shown[:, ~frame.covered] == 0).all()


def test_the_hidden_side_is_the_mirrored_other_and_counts_less(frame: TextureFrame) -> None:
    mesh = photographed(frame, 60)
    photo = painted(mesh, frame)
    aligned = align_photos(frame, [mesh], lambda k: photo)
    sides = [aligned.shown[0][:, :30], aligned.shown[0][:, -30:]]
    hidden, seen = sorted(sides, key=lambda side: side.mean())
    assert 0.1 < hidden[hidden > 0].mean() < 0.55 < seen.max()


def test_beyond_a_photographs_edge_nothing_is_shown(frame: TextureFrame) -> None:
    mesh = photographed(frame, 0)
    photo = painted(mesh, frame)[:260]  # the chin is cut off
    aligned = align_photos(frame, [mesh], lambda k: photo)
    below = frame.lookup(mesh)[..., 1] > 260
    assert below.sum() > 300 and np.percentile(aligned.shown[0][below], 95) < 0.01


def test_the_template_opens_its_mouth_as_the_person_does() -> None:
    closed = np.asarray(canonical_face(), np.float64)
    lower = list(LIPS_INNER[11:])
    meshes = []
    for drop in np.linspace(0, 0.35, 12):
        one = closed.copy()
        one[lower, 1] += drop
        meshes.append(one)
    found = template_shape(np.array(meshes))
    assert mouth_opening(found) == pytest.approx(TEMPLATE_MOUTH_OPENING, abs=0.03)
    still = np.ones(478, np.bool_)
    still[lower] = False
    assert np.abs(found - closed)[still].max() < 0.02


def test_a_mouth_that_never_opens_stays_as_it_is() -> None:
    random = np.random.default_rng(0)
    meshes = canonical_face() + random.normal(0, 0.002, (20, 478, 3))
    assert mouth_opening(template_shape(meshes)) < 0.2
