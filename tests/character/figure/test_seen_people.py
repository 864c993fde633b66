"""People of known pose and shape, drawn, seen by perception and fitted: their joints come back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from trimesh.registration import procrustes

from benchmarks.known_truth.dressed_template import DRESSED_LOOKS, dress
from benchmarks.known_truth.known_person import PERSON_PICTURE_SIZE, KnownPicture, draw_into
from benchmarks.known_truth.known_places import places
from engine.character.figure.figure import Choice, find_figure
from engine.character.figure.silhouette import cut_out
from engine.character.fit.template_fit import load_human
from engine.character.stages import fit_template
from engine.geometry.rigging.skinning import bone_transforms
from engine.media.limits import Limits

SEEN_LOOKS = DRESSED_LOOKS[1:4]
"""Legs apart, a hand on the hip, a stride towards the viewer."""
HUMAN = load_human()
BODY = [k for k, name in enumerate(HUMAN.rig.names) if "Hand" not in name or name.endswith("Hand")]
"""All joints but the fingers'."""


def fitted_joints(known: KnownPicture, folder: Path) -> NDArray[np.float64]:
    """(J, 3) the joints of the template as it is fitted to the picture, as any user's would be."""
    photo = folder / "photo.png"
    Image.fromarray(known.rgb).save(photo)
    figure = find_figure(photo, Choice(), False, Limits(), lambda code, message: None)
    silhouette = cut_out(figure, None, (), Limits(), None, None, lambda code, message: None)
    fit = fit_template(figure, silhouette).fit
    heads = HUMAN.space.joints(fit.coefficients)
    transforms = bone_transforms(HUMAN.rig.parents, heads, fit.rotations, fit.root_translation - heads[0])
    return np.einsum("jab,jb->ja", transforms[:, :3, :3], heads) + transforms[:, :3, 3]


def apart(joints: NDArray[np.float64], truth: NDArray[np.float64]) -> NDArray[np.float64]:
    """Metres between the joints of two bodies, after the similarity that brings them closest (Procrustes)."""
    _, moved, _ = procrustes(joints[BODY], truth[BODY], reflection=False)
    return np.linalg.norm(moved - truth[BODY], axis=1)


def test_perceptions_landmarks_give_the_joints_within_five_centimetres(tmp_path: Path) -> None:
    """In the median over joints and people: less than half of what the template in T-pose is off."""
    behind = places(PERSON_PICTURE_SIZE)["garage"]
    off, unfitted = [], []
    for look in SEEN_LOOKS:
        known = draw_into(dress(look), behind)
        assert known.person.joints is not None
        off.append(apart(fitted_joints(known, tmp_path), known.person.joints))
        unfitted.append(apart(HUMAN.space.joints(np.zeros(1)), known.person.joints))
    assert np.median(off) < 0.05
    assert np.median(off) < np.median(unfitted) / 2
