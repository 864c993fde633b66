"""Limbs of which the picture shows nothing, behind the trunk or another limb: the fitted template has them.

Beyond the paper, whose limbs are all seen. Left to the body, such a limb would be one surface with the trunk that hides it. Its pose
is a guess of the network: it is one in which the limb is hidden.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.body.rig import Rig
from engine.character.figure.picture_space import PictureCamera
from engine.character.fit.head import joint_axes
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, MIN_LIMB_PIXELS, OPPOSITE_LABEL
from engine.imaging.masks.mask_pieces import largest_piece

MIN_VERTICES_INSIDE_SHARE = 0.97
"""Share of the limb's vertices that must be within the person's outline: what is not hidden there would be seen."""
OUTLINE_MARGIN_PIXELS = 2
"""Pixels from the outline within which nothing of a hidden limb can be."""
TRIED_TURNS_DEGREES = sorted(range(-45, 50, 5), key=abs)
"""Degrees by which a limb is turned about its joint, in the picture's plane, until it is within the outline."""
LIMB_BEND_JOINTS = dict(zip((*ARM_LABELS, *LEG_LABELS), ("LeftArm LeftForeArm", "RightArm RightForeArm", "LeftUpLeg LeftLeg", "RightUpLeg RightLeg"), strict=True))  # fmt: skip
"""Each limb's joints: the one about which it turns, and the one at which it bends."""


@dataclass(frozen=True)
class UnseenLimb:
    """A `limb`, an index of `BODY_PARTS`, that is hidden all over: its template's `triangles` (T,), and where it is, `mask` (h, w)."""

    limb: int
    triangles: NDArray[np.bool_]
    mask: NDArray[np.bool_]


def unseen_limbs(labels: Labels, template: PosedTemplate, rig: Rig) -> list[UnseenLimb]:
    """Those of a person that the template has within their outline."""
    part, inner = vertex_parts(rig)[template.triangles], _inner(labels)
    found = []
    for limb in not_seen(labels):
        triangles = (part == limb).any(1)
        if _is_within(template, triangles, inner):
            found.append(UnseenLimb(limb, triangles, largest_piece(template.covers(triangles, inner.shape) & inner)))
    return found


def with_limbs_hidden(
    fitted: FittedBody, camera: PictureCamera, labels: Labels, warn: Callable[[str, str], None]
) -> FittedBody:
    """The fit with limbs that are not seen turned, and stretched if need be, as little as it takes to hide them behind
    the person. It is as it was where nothing does that, as at the picture's edge. `camera`: the grid's. Warns of
    `limb_unseen`."""
    labels = labels.layered
    human, inner = load_human(), _inner(labels)
    part = vertex_parts(human.rig)
    for limb in not_seen(labels):
        for turned in _turned(fitted, limb):
            template = pose_template(turned, camera, human)
            if _is_within(template, (part[template.triangles] == limb).any(1), inner):
                fitted = turned
                name = BODY_PARTS[limb].replace("_", " ")
                warn("limb_unseen", f"Nothing is seen of the {name}: it is made up, like the other one.")
                break
    return fitted


def not_seen(labels: Labels) -> list[int]:
    """The limbs, indices of `BODY_PARTS`, of which the picture shows hardly anything, but the one of the other side. Legs under a skirt are
    not looked for."""
    skirt = labels.cloth is not None and labels.cloth.hangs
    return [
        limb
        for limb, other in OPPOSITE_LABEL.items()
        if (labels.labels == limb).sum() < MIN_LIMB_PIXELS
        and not (labels.hidden == limb).any()
        and largest_piece(labels.labels == other).sum() >= MIN_LIMB_PIXELS
        and not (limb in LEG_LABELS and skirt)
    ]


def _inner(labels: Labels) -> NDArray[np.bool_]:
    """The person's pixels (h, w) behind which a limb is hidden."""
    person = (labels.labels >= 0).astype(np.uint8)
    return np.asarray(cv2.erode(person, np.ones((3, 3), np.uint8), iterations=OUTLINE_MARGIN_PIXELS, borderValue=0) > 0)


def _is_within(template: PosedTemplate, triangles: NDArray[np.bool_], inner: NDArray[np.bool_]) -> bool:
    """Whether a limb of some `triangles` (T,) is among the pixels `inner` (h, w)."""
    x, y = np.rint(template.vertices[np.unique(template.triangles[triangles]), :2]).astype(int).T
    on_grid = (x >= 0) & (y >= 0) & (x < inner.shape[1]) & (y < inner.shape[0])
    return bool((on_grid & inner[np.where(on_grid, y, 0), np.where(on_grid, x, 0)]).mean() > MIN_VERTICES_INSIDE_SHARE)


def _turned(fitted: FittedBody, limb: int) -> Iterator[FittedBody]:
    """The fit with a limb turned more and more, first bent as it is, then stretched."""
    human, fit = load_human(), fitted.fit
    joint, bend = (human.rig.index(name) for name in LIMB_BEND_JOINTS[limb].split())
    heads = human.space.joints(fit.coefficients)
    axes, _ = joint_axes(human.rig.parents, fit.rotations, heads, fit.root_translation)
    for bent in (fit.rotations[bend], np.eye(3)):
        for degrees in TRIED_TURNS_DEGREES:
            turn = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
            rotations = fit.rotations.copy()
            rotations[joint] = axes[human.rig.parents[joint]].T @ turn @ axes[joint]
            rotations[bend] = bent
            yield replace(fitted, fit=replace(fit, rotations=rotations))
