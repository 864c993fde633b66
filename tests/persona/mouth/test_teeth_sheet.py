"""A photograph's upper teeth as a surface."""

from __future__ import annotations

import cv2
import numpy as np

from engine.face_animation.mouth.modelled.resting_mouth import resting_mouth
from engine.face_animation.mouth.pictured.photo_teeth import PhotoTeeth
from engine.face_animation.mouth.pictured.pictured_face import PicturedFace
from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LIPS_INNER
from engine.persona.mouth.teeth_sheet import teeth_sheet


class Nothing:
    def draw(self, frame: np.ndarray, face: np.ndarray, driver_frame: int) -> None: ...


def test_the_sheet_shows_the_photograph_s_teeth_where_the_skull_has_them() -> None:
    front = frontalise(canonical_face()[None].astype(np.float64))[0]
    rest = (front * 80 + (160, 60, 0)).astype(np.float32)
    smile = rest.copy()
    smile[list(LIPS_INNER[11:]), 1] += 12
    rgb = np.full((320, 320, 3), (190, 150, 130), np.uint8)
    cv2.fillPoly(rgb, [np.rint(smile[list(LIPS_INNER), :2]).astype(np.int32)], (225, 215, 200))
    none = np.zeros((0, 478, 2), np.float32)
    at = resting_mouth(front, front)
    sheet = teeth_sheet(PhotoTeeth(at, rgb, rest, PicturedFace(rgb, smile), Nothing(), none))
    shown = sheet.texture[..., 3] > 128
    assert 0.02 < shown.mean() < 0.9
    seen = sheet.texture[shown][:, :3].astype(float)
    assert np.ptp(np.median(seen, axis=0)) < 60, "teeth, and no lips"
    middle = sheet.vertices[np.abs(sheet.vertices[:, 0] - at.middle) < 0.02]
    np.testing.assert_allclose(middle[:, 2], at.depth, atol=0.01)
    assert sheet.vertices[:, 2].max() > at.depth + 0.1, "the arch goes back to both sides"
