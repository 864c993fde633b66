"""Whom a clip shows: told apart are clips that were swapped, and refused those that show nobody, or two people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.resample import resized, size_within
from engine.perception.pose.body import BODY_LANDMARKS, Body
from engine.perception.pose.people import find_people
from engine.perception.solutions import kept_networks

EXAMINED_FRAMES = 12
"""Frames of a clip in which people are looked for, spread over it."""
POSE_SIDE_PIXELS = 640
"""Pixels of the longer side of frames in which people are looked for."""
KNEE_CONFIDENCE = 0.5
"""Confidence from which a knee is in the picture."""
CLOSE_UP_SHARE, WHOLE_SHARE = 0.1, 0.4
"""Of the frames that show somebody: fewer show knees where the head is filmed, and more where the body is."""
SIMILAR_HEIGHT_SHARE = 0.5
"""Of the larger person's height in the picture, from which somebody else is filmed as well, not far in the background."""
MAX_COMPANY_SHARE = 0.15
"""Share of the frames that may show somebody else: one may walk past. Who stands beside is whole in a third of the frames, and found
in half of these."""


@dataclass(frozen=True)
class PeopleShown:
    """The `people` in examined frames, by the frame's number, the largest first; `size` (height, width) of the pictures that
    their points are in."""

    people: Mapping[int, Sequence[Body]]
    size: tuple[int, int]

    def bodies(self, count: int) -> list[Body | None]:
        """The largest person of each of the clip's `count` frames; None in those that were not examined, or show nobody."""
        return [next(iter(self.people.get(frame, ())), None) for frame in range(count)]

    @property
    def share_with_knees(self) -> float:
        """Of the frames that show somebody, how many show a knee; zero where none shows anybody."""
        first = [found[0] for found in self.people.values() if found]
        return float(np.mean([self._knee(body) for body in first])) if first else 0.0

    @property
    def share_with_company(self) -> float:
        """Of all frames that were examined, how many show two people of similar height."""
        pairs = [found for found in self.people.values() if len(found) > 1]
        heights = [np.array([np.ptp(body.points[:, 1]) for body in found]) for found in pairs]
        return sum(bool(height[1] > SIMILAR_HEIGHT_SHARE * height[0]) for height in heights) / max(len(self.people), 1)

    def _knee(self, body: Body) -> bool:
        at = [BODY_LANDMARKS.index(f"{side}Knee") for side in SIDE_NAMES]
        inside = (body.points[at] >= 0).all(1) & (body.points[at] < self.size[::-1]).all(1)
        return bool((inside & (body.confidence[at] > KNEE_CONFIDENCE)).any())


@kept_networks()
def look_for_people(frames: Sequence[NDArray[np.uint8]]) -> PeopleShown:
    """The people, two at most, in a few of a clip's frames (H, W, 3) uint8, spread over it."""
    width, height = size_within(frames[0].shape, POSE_SIDE_PIXELS)
    chosen = np.unique(np.linspace(0, len(frames) - 1, EXAMINED_FRAMES).round().astype(int)).tolist()
    return PeopleShown({k: find_people(resized(frames[k], (width, height)), 2) for k in chosen}, (height, width))


def refuse_wrong_clips(body: PeopleShown, head: PeopleShown | None) -> None:
    """Look whether these are a clip of one person's body and, if there is one, of their head.

    Raises `InputError`: `clips_swapped`, `no_person`, `two_people`.
    """
    if head is not None and body.share_with_knees < CLOSE_UP_SHARE and head.share_with_knees > WHOLE_SHARE:
        raise InputError(
            "clips_swapped",
            "The clip of the body shows a head, and the clip of the head a whole person: give each in the other's place.",
        )
    if not any(body.people.values()):
        raise InputError("no_person", "The clip of the body shows nobody: film a person from head to foot.")
    if body.share_with_company > MAX_COMPANY_SHARE:
        raise InputError(
            "two_people",
            "The clip of the body shows two people: film one alone, and let others step out of the picture.",
        )
