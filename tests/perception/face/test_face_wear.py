"""Glasses across a nose, and hair above a lip."""

from __future__ import annotations

from collections.abc import Callable
from math import isnan, log
from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.media.colour_conversion.tone_mapping import srgb_code
from engine.media.image import read_image
from engine.perception.face.face_wear import face_wear, strongest_path
from engine.perception.face.faces import find_faces
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LIPS_OUTER

Media = Callable[[str], Path]

SKIN = 0.4
"""Linear light of the plain face's skin."""
EYES = 90.0
"""Pixels between its eyes."""


def _face() -> tuple[np.ndarray, np.ndarray]:
    """A plain face, (400, 400) of linear light, and its mesh."""
    return np.full((400, 400), SKIN), canonical_face()[:, :2] * EYES + [200, 170]


def _picture(light: np.ndarray) -> np.ndarray:
    return np.repeat((255 * srgb_code(light)).round().astype(np.uint8)[..., None], 3, 2)


def _upper_lip(light: np.ndarray, mesh: np.ndarray, to: float, halves: tuple[int, ...] = (-1, 1)) -> np.ndarray:
    """Another light between the nose and the mouth."""
    out = light.copy()
    y, x = np.mgrid[:400, :400]
    low, high = mesh[[2, 0], 1]
    width = np.ptp(mesh[list(LIPS_OUTER), 0])
    for half in halves:
        beside = (x - 200) * half
        out[(y > low - 4) & (y < high + 30) & (beside > -1) & (beside < width)] = to
    return out


def test_a_plain_face_wears_nothing() -> None:
    light, mesh = _face()
    wear = face_wear(_picture(light), mesh)
    assert wear.bridge == pytest.approx(0, abs=1e-6)
    assert wear.lip_darkness == pytest.approx(0, abs=1e-6)


def test_a_bridge_is_a_line_from_one_side_to_the_other() -> None:
    light, mesh = _face()
    y = round(float(mesh[6, 1]))
    across, half, fold = light.copy(), light.copy(), light.copy()
    across[y - 4 : y, 150:250] = 0.02
    half[y - 4 : y, 200:250] = 0.02
    fold *= 1 - 0.5 * np.exp(-(((np.arange(400) - y) / 14) ** 2))[:, None]
    bridge, one_side, crease = (face_wear(_picture(one), mesh).bridge for one in (across, half, fold))
    assert bridge > 0.1
    assert one_side < 0.7 * bridge
    assert crease < 0.02


def test_what_is_told_does_not_depend_on_size_or_tilt() -> None:
    light, mesh = _face()
    y = round(float(mesh[6, 1]))
    light[y - 5 : y, 150:250] = 0.05
    picture = _picture(_upper_lip(light, mesh, SKIN / 3))
    plain = face_wear(picture, mesh)
    matrix = cv2.getRotationMatrix2D((200, 200), 17, 1.4)
    turned = cv2.warpAffine(picture, matrix, (400, 400), flags=cv2.INTER_LINEAR)
    wear = face_wear(turned, mesh @ matrix[:, :2].T + matrix[:, 2])
    assert wear.bridge == pytest.approx(plain.bridge, rel=0.25)
    assert wear.lip_darkness == pytest.approx(plain.lip_darkness, rel=0.1)


def test_hair_above_the_lip_is_so_many_times_darker() -> None:
    light, mesh = _face()
    wear = face_wear(_picture(_upper_lip(light, mesh, SKIN / 4)), mesh)
    assert wear.lip_darkness == pytest.approx(log(4), abs=0.05)


def test_a_shadow_from_one_side_is_no_hair() -> None:
    light, mesh = _face()
    assert face_wear(_picture(_upper_lip(light, mesh, SKIN / 4, (1,))), mesh).lip_darkness < 0.1


def test_nothing_is_told_of_faces_that_are_small_or_seen_from_the_side() -> None:
    light, mesh = _face()
    small = face_wear(_picture(light), (mesh - 200) * 0.2 + 200)
    aside = mesh.copy()
    aside[4, 0] += 0.4 * EYES
    for wear in (small, face_wear(_picture(light), aside)):
        assert isnan(wear.bridge)
        assert isnan(wear.lip_darkness)


def test_the_strongest_path_may_climb_a_row_a_column() -> None:
    response = np.zeros((5, 4))
    response[[0, 1, 2, 3], range(4)] = 1.0
    assert strongest_path(response) == 1.0
    response[1, 1], response[4, 1] = 0.0, 1.0
    assert strongest_path(response) == 0.75


@pytest.mark.parametrize(
    ("name", "glasses", "hair"),
    [
        ("photo_man_glasses.jpg", True, False),
        ("photo_biden.jpg", False, False),
        ("photo_woman_outdoor.jpg", False, False),
        ("photo_bw_einstein.jpg", False, True),
    ],
)
def test_people_wear_what_one_sees(media: Media, name: str, glasses: bool, hair: bool) -> None:
    rgb = read_image(media(f"portraits/{name}")).rgb
    wear = face_wear(rgb, find_faces(rgb, most=1)[0])
    assert (wear.bridge > 0.05) == glasses
    assert (wear.lip_darkness > 1.1) == hair
