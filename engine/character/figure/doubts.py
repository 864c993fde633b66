"""Whether a mask and a label map of one's own can be the person's: what their joints say of it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.figure.figure import Figure
from engine.character.figure.placed_joints import REQUIRED_PLACED_JOINTS
from engine.errors import InputError
from engine.imaging.masks.mask_distance import distance_to
from engine.perception.pose.body import BODY_LANDMARKS

SURE_JOINT_CONFIDENCE = 0.8
"""Confidence of joints that are seen. Of those that are guessed, behind a table or another arm, a mask need not have any."""
MASK_TOLERANCE_SHARE = 0.02
"""How far from the mask a joint may be, as a share of the skeleton's height: perception errs by so much."""
MIN_JOINTS_IN_MASK_SHARE = 0.7
"""Share of the joints that are seen which a person's mask has. In nineteen pictures it has all of them, what is not the
person at most 0.27."""
MAX_MASK_SIZE_RATIO = 6.0
"""A mask's size, in sizes of the trunk and of limbs as thick as sticks, from which it is not a person's alone. People
in long skirts have 3, a child's drawing 4.6, whole pictures 7 to 19."""
MIN_LABELLED_SHARE = 0.3
"""Share of the person's pixels in which a label map must say something."""
MIN_TRUNK_LABEL_SHARE = 0.02
"""Share of the person's pixels that a trunk has at least."""
MIN_LIMB_LABEL_SHARE = 0.2
"""Share of a forearm or shin that has its label at least."""
PART_END_JOINTS = {
    f"{side.lower()}_{limb}": (f"{side}{upper}", f"{side}{lower}")
    for side in ("Left", "Right")
    for limb, upper, lower in (("arm", "Elbow", "Wrist"), ("leg", "Knee", "Ankle"))
}
"""The joints between which a part shows, and no other does that belongs there, too."""


def doubt_mask(
    figure: Figure, mask: NDArray[np.bool_], skeleton: NDArray[np.bool_], warn: Callable[[str, str], None]
) -> None:
    """Warn of `mask_misses_joints` and `mask_too_large`. `mask` (H, W): the person's; `skeleton` (H, W): trunk and limbs,
    as thick as sticks."""
    at = (
        np.rint([figure.point(name) for name in REQUIRED_PLACED_JOINTS if _is_seen(figure, name)])
        .astype(int)
        .reshape(-1, 2)
    )
    away = distance_to(mask)
    height = float(np.ptp(figure.points[figure.confidence > 0, 1]))
    held = int((away[at[:, 1], at[:, 0]] <= MASK_TOLERANCE_SHARE * height).sum())
    if held < MIN_JOINTS_IN_MASK_SHARE * len(at):
        warn(
            "mask_misses_joints",
            f"Of {len(at)} joints that are seen {held} are in the mask, which may not be the person's: white is where "
            "the person is, black where they are not.",
        )
    if mask.sum() > MAX_MASK_SIZE_RATIO * skeleton.sum():
        warn(
            "mask_too_large",
            "The mask is far larger than somebody with these joints: paint away what is not the person.",
        )


def require_labels(given: NDArray[np.integer], mask: NDArray[np.bool_]) -> None:
    """Refuse labels (h, w), -1 where nothing is said, that say too little of the person, whose `mask` (h, w) it is.

    Raises
    ------
    InputError : `labels_unreadable`.
    """
    shown = given[mask]
    if (shown >= 0).mean() < MIN_LABELLED_SHARE:
        raise InputError(
            "labels_unreadable",
            f"The label map has the colours of parts in {(shown >= 0).mean():.0%} of the person: paint the parts of the "
            "body in the colours of labels.png.",
            ("labels",),
        )
    if (shown == BODY_PARTS.index("torso")).mean() < MIN_TRUNK_LABEL_SHARE:
        raise InputError(
            "labels_unreadable",
            "The label map shows no trunk: paint all parts of the body in the colours of labels.png.",
            ("labels",),
        )


def doubt_labels(
    figure: Figure, labels: NDArray[np.integer], to_grid: NDArray[np.float64], warn: Callable[[str, str], None]
) -> None:
    """Warn of `labels_unlike_joints`: limbs that are seen and have another label. `labels` (h, w) of the grid, `to_grid` (2, 3)
    from the picture's pixels to its own."""
    other = [limb for limb in PART_END_JOINTS if _shows(figure, labels, to_grid, limb, limb) < MIN_LIMB_LABEL_SHARE]
    if not other:
        return
    mirrored = all(_shows(figure, labels, to_grid, limb, _mirrored(limb)) > 0.5 for limb in other)
    names = ", ".join(limb.replace("_", " ") for limb in other)
    warn(
        "labels_unlike_joints",
        f"The label map has something else where these are seen: {names}. "
        + ("Left and right seem to be exchanged: left is the person's own." if mirrored else "Paint them there."),
    )


def _shows(figure: Figure, labels: NDArray[np.integer], to_grid: NDArray[np.float64], limb: str, part: str) -> float:
    """The share of a limb's lower half that has the label of a part; one where the limb is not seen."""
    joints = PART_END_JOINTS[limb]
    if not all(_is_seen(figure, name) for name in joints):
        return 1.0
    upper, lower = np.stack([figure.point(name) for name in joints]) @ to_grid[:, :2].T + to_grid[:, 2]
    along = np.linspace(0, 1, max(2, round(float(np.linalg.norm(lower - upper)))))[:, None]
    x, y = np.rint(upper + along * (lower - upper)).astype(int).T
    inside = (x >= 0) & (y >= 0) & (x < labels.shape[1]) & (y < labels.shape[0])
    found = labels[y[inside], x[inside]]
    found = found[found >= 0]
    return float((found == BODY_PARTS.index(part)).mean()) if len(found) else 1.0


def _mirrored(limb: str) -> str:
    side, part = limb.split("_")
    return f"{'right' if side == 'left' else 'left'}_{part}"


def _is_seen(figure: Figure, name: str) -> bool:
    """Whether a joint is in the picture and not hidden."""
    height, width = figure.rgb.shape[:2]
    x, y = figure.point(name)
    sure = figure.confidence[BODY_LANDMARKS.index(name)] > SURE_JOINT_CONFIDENCE
    return bool(sure and 0 <= x <= width - 1 and 0 <= y <= height - 1)
