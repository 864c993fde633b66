"""Fingers turned as they are seen: where a hand is seen closely, the fitted template's follows it.

The paper keeps its template's hands flat (section 7); here labels, depth and skinning weights of fingers come from a
template whose fingers are where the person's are.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.fitting.hand_fitting import HandAnchor, HandFit, fingers_apart, fit_hand, hand_length, openness
from engine.character.figure.figure import Figure
from engine.character.fit.head import joint_axes
from engine.character.fit.template_fit import FittedBody, load_human

MAX_MEDIAN_RESIDUAL_LENGTHS = 0.06
"""Lengths of the hand by which half of its landmarks may be off after the fit; beyond, it is not believed."""
MAX_HAND_SCALE_RATIO, MAX_HAND_OFFSET_LENGTHS = 1.6, 0.5
"""How much larger or smaller than the template's a hand may be, and how many of its lengths beside it, to be believed."""
MIN_FINGER_REACH_SHARE, MIN_FINGERTIP_SPREAD_LENGTHS = 0.8, 0.14
"""Share of their lengths that all fingers must reach across the view, and lengths of the hand that must lie between their
tips, for the character to stretch them in T-pose. Of others the picture has one side, and of what touches no border: stretched,
a curled hand would be a web. They stay as they are pictured."""
MIN_HAND_PIXELS = 12.0
"""Pixels; of smaller hands nothing can be said."""


def turn_hands(fitted: FittedBody, figure: Figure) -> FittedBody:
    """The fit with wrists and fingers turned as the figure's hands are; as it was for hands that are not seen, or not to be
    believed."""
    human, fit = load_human(), fitted.fit
    heads = human.space.joints(fit.coefficients)
    rotations, kept = fit.rotations.copy(), fitted.kept.copy()
    for model, hand in zip(human.hands, figure.hands, strict=True):
        if hand is None or (length := hand_length(hand)) < MIN_HAND_PIXELS:
            continue
        axes, places = joint_axes(human.rig.parents, rotations, heads, fit.root_translation)
        wrist, arm = (human.rig.index(f"{model.side}{joint}") for joint in ("Hand", "ForeArm"))
        anchor = HandAnchor(axes[arm], places[wrist], rotations[wrist], fitted.camera)
        found = fit_hand(model, fit.coefficients, anchor, hand)
        if _believed(found, length):
            rotations[found.joints] = found.rotations
            kept[found.joints[1:]] = (
                openness(hand) < MIN_FINGER_REACH_SHARE or fingers_apart(hand) < MIN_FINGERTIP_SPREAD_LENGTHS
            )
            _share_twist(rotations, arm, wrist, heads[wrist] - heads[arm])
    return replace(fitted, fit=replace(fit, rotations=rotations), kept=kept)


def _believed(found: HandFit, length: float) -> bool:
    near = np.linalg.norm(found.shift) < MAX_HAND_OFFSET_LENGTHS * length
    return bool(
        near
        and found.median_error < MAX_MEDIAN_RESIDUAL_LENGTHS
        and 1 / MAX_HAND_SCALE_RATIO < found.scale < MAX_HAND_SCALE_RATIO
    )


def _share_twist(rotations: NDArray[np.float32], arm: int, wrist: int, along: NDArray[np.floating]) -> None:
    """Half of what a hand turns about its forearm's length (3,) is the forearm's, in place: all of it at the wrist would
    wring its skin."""
    axis = along / np.linalg.norm(along)
    x, y, z, w = Rotation.from_matrix(rotations[wrist]).as_quat(canonical=True)
    half = Rotation.from_rotvec(np.arctan2(axis @ [x, y, z], w) * axis).as_matrix()
    rotations[arm] = rotations[arm] @ half
    rotations[wrist] = half.T @ rotations[wrist]
