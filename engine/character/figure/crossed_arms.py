"""Arms crossed before the trunk: which forearm lies before the other, and which hand is seen.

Perception places both wrists in the picture, but says little of which arm is nearer, and of a hand that is tucked away it
makes one up. Which hand shows skin says both.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.fitting.observation import Crossing
from engine.character.figure.figure import MIN_JOINT_CONFIDENCE, Figure
from engine.geometry.rigging.joint_names import SIDE_NAMES, Side
from engine.imaging.masks.colour_segmentation import ColourMixture
from engine.perception.face.landmarks import FACE_OVAL
from engine.perception.pose.body import BODY_LANDMARKS

FINGER_LANDMARKS = ("Pinky", "Index", "Thumb")
HAND_SEARCH_RADIUS_FOREARMS = 0.175
"""How far around its middle a hand is looked for, in lengths of a forearm."""
MIN_VISIBILITY_MARGIN = 0.06
"""By how much more of its place one hand must show than the other to be the one that is seen."""
MAX_SLEEVE_SKIN_SHARE = 0.5
"""Share of the sleeves that may look like skin; of bare arms nothing can be said."""
COLOUR_COPY_SIZE_PIXELS, MIN_SAMPLE_PIXELS = 640, 60
"""Pixels of the longer side of the copy in which colours are compared, and of face or sleeves, at least, to be compared."""
SLEEVE_HALF_WIDTH_ARMS = 0.12
"""Half the width of a sleeve that is looked at, in lengths of the upper arm."""


@dataclass(frozen=True)
class CrossedArms:
    """`crossing`: where the forearms meet, and which is before the other. `skin` (H, W) bool: what has the face's colours rather
    than the sleeves'; None where that is not known."""

    crossing: Crossing
    skin: NDArray[np.bool_] | None

    @property
    def behind(self) -> Side:
        """The side, as in the names of joints, of the arm that is behind the other."""
        return SIDE_NAMES[1 - self.crossing.front]


def crossed_arms(figure: Figure, mask: NDArray[np.bool_]) -> CrossedArms | None:
    """The figure's arms, if they are crossed; None else. That arm is before the other whose hand is seen. Where both
    hands are seen, or none, perception says which arm is nearer. `mask` (H, W): the person."""
    at = {
        f"{side}{name}": figure.point(f"{side}{name}") for side in SIDE_NAMES for name in ("Shoulder", "Elbow", "Wrist")
    }
    if not figure.spatial or not _are_seen(figure) or not _are_crossed(at):
        return None
    skin = _skin(figure, mask, at)
    shows = [0.0, 0.0] if skin is None else [_shown(figure, skin, side) for side in SIDE_NAMES]
    before = (
        shows if abs(shows[0] - shows[1]) > MIN_VISIBILITY_MARGIN else [_depth(figure, side) for side in SIDE_NAMES]
    )
    front = int(before[1] > before[0])
    middle = np.mean([at[f"{side}{name}"] for side in SIDE_NAMES for name in ("Elbow", "Wrist")], axis=0)
    along = [_share(middle, at[f"{side}Elbow"], at[f"{side}Wrist"]) for side in SIDE_NAMES]
    tucked = None
    if skin is not None and shows[1 - front] < MIN_VISIBILITY_MARGIN:
        tucked = _share(
            at[f"{SIDE_NAMES[1 - front]}Wrist"], at[f"{SIDE_NAMES[front]}Shoulder"], at[f"{SIDE_NAMES[front]}Elbow"]
        )
    return CrossedArms(Crossing(front, along[front], along[1 - front], tucked), skin)


def _are_seen(figure: Figure) -> bool:
    """Whether elbows and a wrist are, of somebody who faces the viewer: wrists that are tucked away or cut off are made up."""

    def sure(name: str) -> list[bool]:
        return [
            bool(figure.confidence[BODY_LANDMARKS.index(f"{side}{name}")] > MIN_JOINT_CONFIDENCE) for side in SIDE_NAMES
        ]

    faces = figure.point("LeftShoulder")[0] > figure.point("RightShoulder")[0]
    return bool(faces) and all(sure("Elbow")) and any(sure("Wrist"))


def _are_crossed(at: dict[str, NDArray[np.float32]]) -> bool:
    """Whether each wrist is nearer to the other arm's elbow than to its own."""

    def apart(one: str, other: str) -> float:
        return float(np.linalg.norm(at[one] - at[other]))

    return all(
        apart(f"{own}Wrist", f"{other}Elbow") < apart(f"{own}Wrist", f"{own}Elbow")
        for own, other in (SIDE_NAMES, SIDE_NAMES[::-1])
    )


def _skin(figure: Figure, mask: NDArray[np.bool_], at: dict[str, NDArray[np.float32]]) -> NDArray[np.bool_] | None:
    """What of the person (H, W) has the face's colours rather than the sleeves'; None where no face is seen,
    too little of either, or both are alike."""
    if figure.face is None:
        return None
    factor = min(1.0, COLOUR_COPY_SIZE_PIXELS / max(mask.shape))
    size = (round(mask.shape[1] * factor), round(mask.shape[0] * factor))
    person = cv2.resize(mask.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST_EXACT) > 0
    face, sleeves = np.zeros(person.shape, np.uint8), np.zeros(person.shape, np.uint8)
    cv2.fillConvexPoly(face, cv2.convexHull(np.rint(factor * figure.face[FACE_OVAL, :2]).astype(np.int32)), (1,))
    for side in SIDE_NAMES:
        ends = [factor * at[f"{side}{name}"] for name in ("Shoulder", "Elbow")]
        wide = max(1, round(2 * SLEEVE_HALF_WIDTH_ARMS * float(np.linalg.norm(ends[1] - ends[0]))))
        start, end = (np.rint(end).astype(int).tolist() for end in ends)
        cv2.line(sleeves, start, end, (1,), wide)
    colours = cv2.resize(figure.rgb, size, interpolation=cv2.INTER_AREA).astype(np.float64)
    own, worn = (colours[(area > 0) & person] for area in (face, sleeves))
    if min(len(own), len(worn)) < MIN_SAMPLE_PIXELS:
        return None
    skin, cloth = ColourMixture.fit(own), ColourMixture.fit(worn)
    if (skin.negative_log_likelihood(worn) < cloth.negative_log_likelihood(worn)).mean() > MAX_SLEEVE_SKIN_SHARE:
        return None
    found = np.zeros(person.shape, np.uint8)
    found[person] = skin.negative_log_likelihood(colours[person]) < cloth.negative_log_likelihood(colours[person])
    full = cv2.resize(found, (mask.shape[1], mask.shape[0]), interpolation=cv2.INTER_NEAREST_EXACT)
    return np.asarray(full > 0) & mask


def _shown(figure: Figure, skin: NDArray[np.bool_], side: str) -> float:
    """Share of the place of a hand, a disk around its middle, that has the skin's colours."""
    middle = np.mean([figure.point(f"{side}{name}") for name in FINGER_LANDMARKS], axis=0)
    reach = HAND_SEARCH_RADIUS_FOREARMS * float(
        np.linalg.norm(figure.point(f"{side}Elbow") - figure.point(f"{side}Wrist"))
    )
    place = np.zeros(skin.shape, np.uint8)
    cv2.circle(place, tuple(np.rint(middle).astype(int).tolist()), max(2, round(reach)), (1,), -1)
    return float(skin[place > 0].mean()) if place.any() else 0.0


def _depth(figure: Figure, side: str) -> float:
    """Metres by which perception has a forearm nearer than the hips."""
    return float(np.mean([figure.world[BODY_LANDMARKS.index(f"{side}{name}"), 2] for name in ("Elbow", "Wrist")]))


def _share(point: NDArray[np.floating], start: NDArray[np.floating], end: NDArray[np.floating]) -> float:
    """How far along from start to end a point is, in [0, 1]."""
    along = end - start
    return float(np.clip((point - start) @ along / max(float(along @ along), 1e-6), 0, 1))


def without_hidden_hand(figure: Figure, arms: CrossedArms | None) -> Figure:
    """The figure without the hand that is tucked behind the other arm, if one is: whatever is found of it is made up."""
    if arms is None or arms.crossing.tucked_at is None:
        return figure
    confidence = figure.confidence.copy()
    confidence[[BODY_LANDMARKS.index(f"{arms.behind}{name}") for name in FINGER_LANDMARKS]] = 0
    left, right = figure.hands
    hands = (left, None) if arms.behind == "Right" else (None, right)
    return replace(figure, confidence=confidence, hands=hands)
