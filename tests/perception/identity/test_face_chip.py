"""Faces laid on fixed places."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.perception.face.head_pose import canonical_face
from engine.perception.identity.face_chip import ARCFACE_LAYOUT, DLIB_LAYOUT, ChipLayout, face_chip


@pytest.mark.parametrize("layout", [DLIB_LAYOUT, ARCFACE_LAYOUT])
@pytest.mark.parametrize("size", [40.0, 180.0])
def test_landmarks_lie_where_the_layout_has_them(layout: ChipLayout, size: float) -> None:
    turned = cv2.getRotationMatrix2D((0, 0), 20, size)[:, :2]
    mesh = canonical_face()[:, :2] @ turned.T + 400
    picture = np.zeros((800, 800, 3), np.uint8)
    for k, vertices in enumerate(layout.vertices):
        colour = np.zeros(3)
        colour[k % 3] = 255
        x, y = mesh[list(vertices)].mean(axis=0)
        cv2.circle(picture, (round(x), round(y)), max(2, round(size / 20)), colour.tolist(), -1)
    chip = face_chip(picture, mesh, layout)
    assert chip.shape == (layout.side, layout.side, 3)
    for k, place in enumerate(layout.places):
        channel = chip[..., k % 3].astype(float)
        ys, xs = np.mgrid[: layout.side, : layout.side]
        near = channel * (np.hypot(xs - place[0], ys - place[1]) < 0.09 * layout.side)
        assert near.sum() > 0, "a landmark is drawn there"
        found = np.array([(near * xs).sum(), (near * ys).sum()]) / near.sum()
        # the canonical face is nobody's mean of the layout's: a similarity lays five points on five to a few pixels
        assert np.hypot(*(found - place)) < 0.06 * layout.side


def test_a_large_face_is_shrunk_by_means() -> None:
    fine = np.indices((1600, 1600)).sum(0) % 2 * 255
    chip = face_chip(
        np.repeat(fine[..., None], 3, 2).astype(np.uint8), canonical_face()[:, :2] * 400 + 800, ARCFACE_LAYOUT
    )
    assert np.abs(chip[20:90, 20:90].astype(int) - 127).max() < 16, "a chequered picture is grey from afar"
