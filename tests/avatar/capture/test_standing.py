"""Somebody who stands where they are is seen there by all cameras; somebody who walks away is not."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from made_orbit import SIZE, observed, orbit
from numpy.typing import NDArray

from engine.avatar.capture.scene_cameras import ClipScene
from engine.avatar.capture.standing import refuse_walking, share_astray
from engine.errors import InputError
from engine.geometry.multiview.bundle import Bundle
from engine.geometry.multiview.structure_from_motion.mapping import Reconstruction
from engine.geometry.multiview.structure_from_motion.tracks import Tracks

FRAMES = 24


def scene_of(bundle: Bundle) -> ClipScene:
    seen = observed(bundle)
    tracks = Tracks(seen.point, seen.camera, np.arange(len(seen)), len(bundle.points))
    there, agreed = np.ones(FRAMES, np.bool_), np.ones(len(seen), np.bool_)
    return ClipScene(Reconstruction(bundle, there, tracks, seen, agreed), (), SIZE)


def silhouettes(bundle: Bundle, places: NDArray[np.floating]) -> list[NDArray[np.bool_]]:
    """Masks of half the pictures' size: a pole that stands at a place (x, z) in each frame."""
    masks = []
    for c, (x, z) in enumerate(places):
        drawn = np.zeros((SIZE[0] // 2, SIZE[1] // 2), np.uint8)
        ends = bundle.camera(c, SIZE).project(np.array([[x, 0.0, z], [x, 1.7, z]]))
        if (ends[:, 2] > 0.1).all():
            (x0, y0), (x1, y1) = np.rint((ends[:, :2] + 0.5) / 2 - 0.5).astype(int).tolist()
            cv2.line(drawn, (x0, y0), (x1, y1), (1,), 24)
        masks.append(drawn > 0)
    return masks


def test_who_sways_stays_and_who_walks_away_is_refused() -> None:
    bundle = orbit(FRAMES, turn=4 * np.pi)
    scene = scene_of(bundle)
    random = np.random.default_rng(2)
    swaying = 0.01 * random.standard_normal((FRAMES, 2))
    masks = silhouettes(bundle, swaying)
    assert share_astray(scene, masks) == 0
    masks[5] = np.zeros_like(masks[5])  # a frame in which nobody was found is forgiven
    refuse_walking(scene, masks)
    away = bundle.rotations.copy()
    away[:4] = np.diag([-1.0, 1.0, -1.0]) @ away[:4]  # these look the other way, where somebody is in the middle, too
    shifts = -np.einsum("cij,cj->ci", away, bundle.eyes)
    turned = scene_of(replace(bundle, rotations=away, translations=shifts))
    assert share_astray(turned, silhouettes(bundle, swaying)) == pytest.approx(4 / FRAMES)
    walking = swaying + np.clip(np.arange(FRAMES) / FRAMES - 0.45, 0, 0.15)[:, None] / 0.15 * [1.2, 0]
    with pytest.raises(InputError) as refused:
        refuse_walking(scene, silhouettes(bundle, walking))
    assert refused.value.code == "person_walks"
    assert share_astray(scene, [np.zeros_like(mask) for mask in masks]) == 1
