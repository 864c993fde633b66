"""Crossed arms on the body label map: sleeves along their bones, hands where skin is seen.

Two arms of one cloth before a trunk of the same have no colours to part them, and the template's hands, stretched flat, reach
far beyond hands that are tucked away. So each arm is as wide along its bones as the picture has it at its elbow, the one in
front covers the other, and the other is known where it is covered.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.body.rig import Rig
from engine.character.figure.crossed_arms import CrossedArms
from engine.character.figure.figure import Figure
from engine.character.fit.posed_template import PosedTemplate
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside
from engine.imaging.masks.mask_pieces import largest_piece

MIN_ELBOW_HALF_WIDTH_METRES, MAX_ELBOW_HALF_WIDTH_METRES = 0.045, 0.085
"""Metres that half the width of an arm at its elbow has, at least and at most."""
SHOULDER_WIDTH_RATIO, WRIST_WIDTH_RATIO = 0.65, 0.75
"""Half the widths of an arm at shoulder and wrist, as shares of that at the elbow."""
SLEEVE_WIDTH_RATIO, SLEEVE_SAG_SHARE = 1.2, 0.35
"""A sleeve is wider than from the joint to the outline; that of the arm behind is seen below the other, and hangs."""
PALM_HALF_WIDTH_METRES, BENT_FINGERS_HALF_WIDTH_METRES = 0.045, 0.03
"""Metres that half the width of a hand has, at palm and bent fingers."""
HAND_REACH_METRES = 0.13
"""Metres from the wrist to the middle of bent fingers."""
UNTUCKED_BAND_PIXELS = 4.0
"""Pixels of the grid from the person's outline in which no hand is tucked away."""
CIRCLES_PER_BONE = 24
"""Circles that make an arm from one joint to the next."""


@dataclass(frozen=True)
class Behind:
    """A `limb`, an index of `BODY_PARTS`, that goes on behind another in an `area` (h, w), of which some is its `hand` (h, w)."""

    limb: int
    area: NDArray[np.bool_]
    hand: NDArray[np.bool_]


@dataclass(frozen=True)
class ArmLabels:
    """On the grid, the arm that is `shown` (h, w) int8, an index of `BODY_PARTS`, -1 elsewhere; and what of one is behind the
    other."""

    shown: NDArray[np.int8]
    behind: Behind


def label_crossed(
    figure: Figure,
    arms: CrossedArms,
    template: PosedTemplate,
    rig: Rig,
    to_grid: NDArray[np.float64],
    mask: NDArray[np.bool_],
) -> ArmLabels:
    """The crossed arms of the figure, whose person covers `mask` (h, w) of the grid; `to_grid` (2, 3) leads there from the
    picture's pixels."""
    size = (mask.shape[1], mask.shape[0])
    skin = mask
    if arms.skin is not None:
        skin = np.asarray(cv2.warpAffine(arms.skin.astype(np.float32), to_grid, size, flags=cv2.INTER_AREA)) > 0.5
    front, back = SIDE_NAMES[arms.crossing.front], arms.behind
    own = {side: _Arm.of(side, figure, template, rig, to_grid, mask) for side in SIDE_NAMES}
    covers = {
        side: arm.sleeve(mask.shape, SLEEVE_SAG_SHARE if side == back else 0.0) & mask for side, arm in own.items()
    }
    hands = {side: arm.hand(mask.shape) & mask for side, arm in own.items()}
    if arms.crossing.tucked_at is not None:  # at the outline the arm before it is too thin to hide it from all sides
        hands[back] &= distance_inside(mask) > UNTUCKED_BAND_PIXELS
    reach = dilate_mask(hands[front] | covers[front], 2)
    seen = largest_piece(covers[front] | (hands[front] & skin & reach))
    whole = covers[back] | hands[back]
    shown = np.full(mask.shape, -1, np.int8)
    shown[whole & (covers[back] | skin)] = BODY_PARTS.index(f"{back.lower()}_arm")
    shown[seen] = BODY_PARTS.index(f"{front.lower()}_arm")
    return ArmLabels(shown, Behind(BODY_PARTS.index(f"{back.lower()}_arm"), whole, whole & ~covers[back]))


@dataclass(frozen=True)
class _Arm:
    """An arm on the grid, pixels.

    shoulder, elbow, wrist, fingers : (2,) where they are.
    wide : half the width at the elbow.
    metre : how many pixels one has.
    """

    shoulder: NDArray[np.float64]
    elbow: NDArray[np.float64]
    wrist: NDArray[np.float64]
    fingers: NDArray[np.float64]
    wide: float
    metre: float

    @classmethod
    def of(
        cls,
        side: str,
        figure: Figure,
        template: PosedTemplate,
        rig: Rig,
        to_grid: NDArray[np.float64],
        mask: NDArray[np.bool_],
    ) -> _Arm:
        shoulder, elbow = (
            to_grid[:, :2] @ figure.point(f"{side}{name}") + to_grid[:, 2] for name in ("Shoulder", "Elbow")
        )
        forearm, wrist = (template.joints[rig.index(f"{side}{name}"), :2] for name in ("ForeArm", "Hand"))
        along = (wrist - forearm) / max(float(np.linalg.norm(wrist - forearm)), 1e-6)
        inside = distance_inside(mask)
        x, y = np.clip(np.rint(elbow), 0, [mask.shape[1] - 1, mask.shape[0] - 1]).astype(int)
        metre = template.pixels_per_metre
        wide = SLEEVE_WIDTH_RATIO * float(
            np.clip(inside[y, x], MIN_ELBOW_HALF_WIDTH_METRES * metre, MAX_ELBOW_HALF_WIDTH_METRES * metre)
        )
        return cls(shoulder, elbow, wrist, wrist + HAND_REACH_METRES * metre * along, wide, metre)

    def sleeve(self, shape: Sequence[int], sag: float = 0.0) -> NDArray[np.bool_]:
        """The pixels (h, w) of the sleeve, which hangs below the forearm by `sag` of half its width."""
        upper = _tapered(shape, self.shoulder, self.elbow, SHOULDER_WIDTH_RATIO * self.wide, self.wide)
        for down in {0.0, sag * self.wide}:
            elbow, wrist = (joint + np.array([0, down]) for joint in (self.elbow, self.wrist))
            upper |= _tapered(shape, elbow, wrist, self.wide, WRIST_WIDTH_RATIO * self.wide)
        return upper

    def hand(self, shape: Sequence[int]) -> NDArray[np.bool_]:
        return _tapered(
            shape,
            self.wrist,
            self.fingers,
            PALM_HALF_WIDTH_METRES * self.metre,
            BENT_FINGERS_HALF_WIDTH_METRES * self.metre,
        )


def _tapered(
    shape: Sequence[int], start: NDArray[np.float64], end: NDArray[np.float64], wide: float, narrow: float
) -> NDArray[np.bool_]:
    """The pixels (h, w) around a line whose half width goes from `wide` at its start to `narrow` at its end."""
    drawn = np.zeros((shape[0], shape[1]), np.uint8)
    for share in np.linspace(0, 1, CIRCLES_PER_BONE):
        x, y = np.rint(start + share * (end - start)).astype(int).tolist()
        cv2.circle(drawn, (x, y), max(1, round(wide + share * (narrow - wide))), (1,), -1)
    return np.asarray(drawn > 0)
