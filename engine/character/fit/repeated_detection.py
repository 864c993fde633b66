"""A person detected again, cut out of the picture and mirrored: test-time augmentation.

Perception looks at pictures with all that is in them, and takes a bench for a leg, or somebody in a helmet for somebody seen from
behind. The mask takes its surroundings away. What looks that agree say is averaged: their errors are not the same. Those that do not
are as many beginnings of a fit (`engine.character.fit.template_fit`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.figure import MIN_JOINT_CONFIDENCE, Figure, moved_along
from engine.imaging.masks.mask_pieces import bounding_box
from engine.perception.pose.body import BODY_LANDMARKS, FAINT_CONFIDENCE, Body, find_body

BACKDROP_GREY_LEVEL = 128
"""Of what is before and behind the person."""
GREY_MARGIN_SHARE = 0.15
"""Of grey around the person, as a share of the height."""
MAX_INPUT_HEIGHT_PIXELS = 512
"""Pixels of the person's height, at most, when they are looked at: the network makes less of it."""
MAX_JOINT_DISAGREEMENT_SHARE = 0.06
"""How far apart two looks have a joint that both see, at most, where they agree; as a share of the height."""
COMPARED_LANDMARKS = tuple(
    BODY_LANDMARKS.index(f"{side}{joint}")
    for side in ("Left", "Right")
    for joint in ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle")
)
MIRRORED_LANDMARKS = np.array([
    BODY_LANDMARKS.index(
        name.replace("Left", "Right") if "Left" in name else name.replace("Right", "Left")
    )
    for name in BODY_LANDMARKS
])  # fmt: skip
"""The landmarks of the other side."""


def detect_again(figure: Figure, alpha: NDArray[np.floating]) -> list[Figure]:
    """The figure as it was seen, then as it is seen cut out by its mask, `alpha` (H, W). There are fewer where looks
    agree, and are one, or where nobody is seen. Joints that were placed by hand stay. Whom the picture's border cuts is
    not cut out: in grey they would end there, and legs would be found above."""
    mask = alpha > 0.5
    if not figure.spatial or mask[[0, -1]].any() or mask[:, [0, -1]].any():
        return [figure]
    looks = [figure]
    for mirror in (False, True):
        body = _detect(figure.rgb, alpha, mirror)
        if body is not None:
            looks.append(_as_seen(figure, body))
    rows = bounding_box(alpha > 0.5)[0]
    return _in_agreement(looks, float(rows.stop - rows.start))


def _detect(rgb: NDArray[np.uint8], alpha: NDArray[np.floating], mirror: bool) -> Body | None:
    """The body in what `alpha` (H, W) leaves of a picture, in the picture's pixels."""
    rows, columns = bounding_box(alpha > 0.5)
    shown = alpha[rows, columns, None]
    person = np.asarray(rgb[rows, columns] * shown + BACKDROP_GREY_LEVEL * (1 - shown), np.uint8)
    scale = min(1.0, MAX_INPUT_HEIGHT_PIXELS / person.shape[0])
    size = (max(1, round(person.shape[1] * scale)), max(1, round(person.shape[0] * scale)))
    person = np.asarray(cv2.resize(person, size, interpolation=cv2.INTER_AREA), np.uint8)
    margin = round(GREY_MARGIN_SHARE * size[1])
    person = np.pad(person, ((margin, margin), (margin, margin), (0, 0)), constant_values=BACKDROP_GREY_LEVEL)
    body = find_body(person[:, ::-1] if mirror else person, FAINT_CONFIDENCE)
    if body is None:
        return None
    points, world, confidence = body.points, body.world, body.confidence
    if mirror:
        points = (points * [-1, 1] + [person.shape[1] - 1, 0])[MIRRORED_LANDMARKS]
        world, confidence = (world * [-1, 1, 1])[MIRRORED_LANDMARKS], confidence[MIRRORED_LANDMARKS]
    points = (points - margin + 0.5) / scale - 0.5 + [columns.start, rows.start]
    return Body(points.astype(np.float32), world.astype(np.float32), confidence)


def _as_seen(figure: Figure, body: Body) -> Figure:
    """The figure with the joints of another look but for those that were placed by hand."""
    points, confidence = body.points.copy(), body.confidence.copy()
    placed = [BODY_LANDMARKS.index(name) for name in figure.placed]
    points[placed], confidence[placed] = figure.points[placed], figure.confidence[placed]
    return replace(figure, points=points, confidence=confidence, world=moved_along(body, points, figure.placed))


def _in_agreement(looks: Sequence[Figure], height: float) -> list[Figure]:
    """One figure, the mean, for all that agree with one another."""
    groups: list[list[Figure]] = []
    for look in looks:
        for group in groups:
            if all(_agree(look, other, height) for other in group):
                group.append(look)
                break
        else:
            groups.append([look])
    return [_mean(group) for group in groups]


def _agree(one: Figure, other: Figure, height: float) -> bool:
    away = np.linalg.norm(one.points[COMPARED_LANDMARKS, :] - other.points[COMPARED_LANDMARKS, :], axis=1)
    seen = np.minimum(one.confidence, other.confidence)[list(COMPARED_LANDMARKS)] > MIN_JOINT_CONFIDENCE
    return bool((away[seen] < MAX_JOINT_DISAGREEMENT_SHARE * height).all())


def _mean(group: Sequence[Figure]) -> Figure:
    """The mean of looks that agree. What the first is sure of, as it was placed by hand or seen closely, stays."""

    def mean(name: str) -> NDArray[np.float32]:
        return np.asarray(np.mean([getattr(look, name) for look in group], axis=0), np.float32)

    sure = group[0].confidence == 1
    return replace(
        group[0],
        points=np.where(sure[:, None], group[0].points, mean("points")),
        confidence=np.where(sure, 1, mean("confidence")),
        world=mean("world"),
    )
