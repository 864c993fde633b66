"""Feet in the masks of a person, told from the floor by what the floor looks like there.

Networks lose feet, and colours alone do not tell dark shoes from a dark carpet. The floor's own look is known from the
frames in which no foot covers it (`floor_mosaic`). The person's colours are known from where landmarks have their legs.
Each pixel about a foot is of one or of the other, and a cut along contrasts parts them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.floor_mosaic import FloorMosaic, FloorView, cost_among_strange, floor_mosaic
from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.body.fitting.residuals import FOOT_LANDMARKS, MIN_DEPTH_METRES
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.masks.colour_segmentation import MIN_MIXTURE_PIXELS, ColourMixture, ContrastGraph
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, near_lines
from engine.imaging.masks.mask_pieces import without_small_pieces

FOOT_REACH_LENGTHS = 0.6
"""How far from its marks a foot may reach, in its lengths, and the floor is told from it."""
CERTAIN_FOOT_SHARES = {"Heel": 0.5, "FootIndex": 0.7}
"""How far from the ankle to a corner it is surely a foot, as a share of the way."""
CERTAIN_SHIN_SHARE = 0.5
"""Of the way to the knee, how much is surely a leg."""
SURE_FOOT_HALF_WIDTH_LENGTHS = 0.04
"""Half the width of what surely is, in lengths of the foot."""
CUT_ROUNDS = 2
"""How often masks and floor are found from each other."""
MASK_COVER_PIXELS = 2
"""Around a mask, that are not taken for the floor's."""
INNER_PIXELS = 1.5
"""From a mask's outline, beyond which it surely shows the person."""
FOOT_SPECK_SHARE = 0.02
"""Of a square as wide as a foot is long: smaller pieces, and holes, are nobody's."""
MASK_COST = 1.0
"""What it costs a pixel to be told otherwise than the mask before has it: less than colours that say anything."""


@dataclass(frozen=True)
class Foot:
    """A foot by its marks, metres: `corners` (3, 3), and `lines` (L, 2, 3) within foot and shin."""

    corners: NDArray[np.float64]
    lines: NDArray[np.float64]


@dataclass(frozen=True)
class FootFrame:
    """A frame in which feet are looked for: `image` (h, w, 3), the `mask` (h, w) so far, the camera locked to the `person` and as the
    `room` has it, both of its size."""

    image: NDArray[np.uint8]
    mask: NDArray[np.bool_]
    person: Camera
    room: Camera


@dataclass(frozen=True)
class _Near:
    """A part of a frame about feet: its `rows` and `columns`, where in it feet may reach (`area`) and where surely somebody is."""

    rows: slice
    columns: slice
    area: NDArray[np.bool_]
    sure: NDArray[np.bool_]
    foot_pixels: float


def feet_of(landmarks: SpatialLandmarks) -> list[Foot]:
    """The feet whose corners are known."""
    found = []
    for side in SIDE_NAMES:
        known = [landmarks.body.get(f"{side}{corner}") for corner in FOOT_LANDMARKS]
        if any(one is None for one in known):
            continue
        corners = np.array(known, np.float64)
        lines = [
            [corners[0], corners[0] + share * (end - corners[0])]
            for end, share in zip(corners[1:], CERTAIN_FOOT_SHARES.values(), strict=True)
        ]
        knee = landmarks.body.get(f"{side}Knee")
        if knee is not None:
            lines.append([corners[0], corners[0] + CERTAIN_SHIN_SHARE * (np.asarray(knee) - corners[0])])
        found.append(Foot(corners, np.array(lines)))
    return found


def told_from_floor(frames: Sequence[FootFrame], feet: Sequence[Foot]) -> list[NDArray[np.bool_]]:
    """The frames' masks with the feet as they stand out from the floor."""
    masks = [frame.mask.copy() for frame in frames]
    if not feet:
        return masks
    parts = [_near(frame, feet) for frame in frames]
    covered = [_covered(mask, part) for mask, part in zip(masks, parts, strict=True)]
    ours = [None if part is None else part.sure for part in parts]
    around, height = np.concatenate([foot.corners for foot in feet]), None
    for _ in range(CUT_ROUNDS):
        views = [FloorView(f.image, c, f.room) for f, c in zip(frames, covered, strict=True)]
        floor = floor_mosaic(views, around, height)
        if floor is None:
            return masks
        height = floor.height
        person = _person_colours(frames, parts, ours, floor)
        if person is None:
            return masks
        for n, (frame, part) in enumerate(zip(frames, parts, strict=True)):
            if part is not None:
                masks[n][part.rows, part.columns] = _told_apart(frame, part, masks[n], floor, person, floor.gains[n])
                ours[n] = part.sure | (distance_inside(masks[n][part.rows, part.columns] & part.area) > INNER_PIXELS)
        covered = [dilate_mask(mask, MASK_COVER_PIXELS) for mask in masks]
    return masks


def _near(frame: FootFrame, feet: Sequence[Foot]) -> _Near | None:
    """The part of a frame about those feet that it shows."""
    height, width = frame.mask.shape
    area, sure = np.zeros((height, width), np.bool_), np.zeros((height, width), np.bool_)
    lengths = []
    for foot in feet:
        if frame.person.depth(np.concatenate([foot.corners, foot.lines.reshape(-1, 3)])).min() < MIN_DEPTH_METRES:
            continue
        corners = frame.person.project(foot.corners, np.float64)[:, :2]
        if ((corners < 0) | (corners > [width - 1, height - 1])).all():
            continue
        pixels_per_metre = frame.person.focal / float(frame.person.depth(foot.corners.mean(0)))
        length = pixels_per_metre * float(np.linalg.norm(foot.corners[1] - foot.corners[2]))
        lines = frame.person.project(foot.lines.reshape(-1, 3), np.float64)[:, :2].reshape(-1, 2, 2)
        area |= near_lines(area.shape, corners[[[0, 1], [1, 2], [2, 0]]], FOOT_REACH_LENGTHS * length)
        sure |= near_lines(area.shape, lines, SURE_FOOT_HALF_WIDTH_LENGTHS * length)
        lengths.append(length)
    if not area.any():
        return None
    rows, columns = (np.flatnonzero(area.any(axis)) for axis in (1, 0))
    part = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    return _Near(*part, area[part], sure[part] & area[part], float(np.mean(lengths)))


def _covered(mask: NDArray[np.bool_], part: _Near | None) -> NDArray[np.bool_]:
    """Where the person may be, before anything is known of the floor."""
    covered = dilate_mask(mask, 2 * MASK_COVER_PIXELS)
    if part is not None:
        covered[part.rows, part.columns] |= part.area
    return covered


def _person_colours(
    frames: Sequence[FootFrame],
    parts: Sequence[_Near | None],
    ours: Sequence[NDArray[np.bool_] | None],
    floor: FloorMosaic,
) -> ColourMixture | None:
    """The colours of feet and shins, in the floor's exposure."""
    seen = [
        frame.image[part.rows, part.columns][own] / gain
        for frame, part, own, gain in zip(frames, parts, ours, floor.gains, strict=True)
        if part is not None and own is not None
    ]
    colours = np.concatenate(seen) if seen else np.zeros((0, 3))
    return ColourMixture.fit(colours) if len(colours) >= MIN_MIXTURE_PIXELS else None


def _told_apart(
    frame: FootFrame,
    part: _Near,
    mask: NDArray[np.bool_],
    floor: FloorMosaic,
    person: ColourMixture,
    gain: NDArray[np.float64],
) -> NDArray[np.bool_]:
    """The mask of a part, told anew where feet may reach."""
    image = frame.image[part.rows, part.columns]
    camera = frame.room.cropped(part.columns.start, part.rows.start, (image.shape[0], image.shape[1]))
    of_floor = floor.cost(image, gain, camera)[part.area]
    of_person = cost_among_strange(np.exp(-person.negative_log_likelihood(image[part.area] / gain)))
    before = mask[part.rows, part.columns]
    costs = np.stack([of_floor, of_person], 1) + MASK_COST * (before[part.area, None] != np.array([False, True]))
    graph = ContrastGraph.of(image.astype(np.float64), part.area)
    found = before.copy()
    found[part.area] = graph.cut(costs, np.zeros(len(costs), np.intp)) == 1
    least = FOOT_SPECK_SHARE * part.foot_pixels**2
    found = without_small_pieces(~without_small_pieces(~found, least), least)
    return np.where(part.area, found, before)
