"""The floor that masks of a person let in between legs, and between these and coat tails, told by what the floor looks like there.

Networks fill such gaps in most frames alike, so that no frame contradicts the others. But the floor behind them is known from the
frames in which nobody stands before it (`floor_mosaic`): what looks like that very place of the floor is not the person.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.floor_mosaic import FloorMosaic, FloorView, cost_among_strange, floor_mosaic
from engine.avatar.capture.foot_masks import INNER_PIXELS, MASK_COST, MASK_COVER_PIXELS, FootFrame
from engine.avatar.landmarks.in_frames import KNUCKLE_LANDMARKS
from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.body.fitting.residuals import MIN_DEPTH_METRES
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.masks.colour_segmentation import MIN_MIXTURE_PIXELS, ColourMixture, ContrastGraph
from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, near_lines
from engine.imaging.masks.mask_pieces import without_small_pieces

LEG_LANDMARKS = ("Hip", "Knee", "Ankle")
"""The body's landmarks, of each side, between which gaps are looked for."""
LEG_REACH_METRES = 0.15
"""Metres about the legs within which gaps are looked for: coat tails hang so far off them."""
HAND_BLANK_METRES = 0.12
"""Metres about the knuckles within which nothing is looked for: fingers are thin, and skin has the colours of wooden floors."""
FLOOR_REACH_METRES = 2.0
"""Metres about the person to which the floor is looked at: what cameras at breast height see between thighs."""
GAP_MOSAIC_SPACING_METRES = 0.01
"""Metres between points of the mosaic: floor that is seen behind somebody is far, and seen flatly."""
MIN_STRANGER_SIGMAS = 4.0
"""Sigmas from the floor behind it beyond which a pixel of the mask is surely the person's, and tells of their colours."""
MIN_GAP_METRES = 0.02
"""Metres along a side of a square: smaller gaps are specks."""
MAX_GAP_SHARE = 0.3
"""Share of a mask about the legs: what takes more of it away takes trousers of the floor's colour."""


@dataclass(frozen=True)
class _Legs:
    """A frame about the legs.

    rows, columns : the part of the picture.
    area : (h, w) bool, the mask's pixels about the legs.
    pixels_per_metre : there.
    """

    rows: slice
    columns: slice
    area: NDArray[np.bool_]
    pixels_per_metre: float


def without_gaps(frames: Sequence[FootFrame], landmarks: SpatialLandmarks) -> list[NDArray[np.bool_]]:
    """The frames' masks without the floor about the legs whose `landmarks` are known; as they are where one is missing, or the floor or
    the person's colours are not known."""
    masks = [frame.mask.copy() for frame in frames]
    known = [landmarks.body.get(f"{side}{name}") for side in SIDE_NAMES for name in LEG_LANDMARKS]
    if any(one is None for one in known):
        return masks
    legs = np.array(known, np.float64)
    hands = _hands(landmarks)
    views = [FloorView(one.image, dilate_mask(one.mask, MASK_COVER_PIXELS), one.room) for one in frames]
    floor = floor_mosaic(views, _floor_around(legs), spacing=GAP_MOSAIC_SPACING_METRES)
    if floor is None:
        return masks
    parts = [_about_legs(frame, legs, hands) for frame in frames]
    person = _colours_before_floor(frames, parts, floor)
    if person is None:
        return masks
    for frame, part, mask, gain in zip(frames, parts, masks, floor.gains, strict=True):
        if part is not None:
            mask[part.rows, part.columns] &= ~_gaps(frame, part, floor, person, gain)
    return masks


def _hands(landmarks: SpatialLandmarks) -> list[NDArray[np.float64]]:
    """The middle (3,) of the knuckles of those hands of which they are known."""
    found = []
    for side in SIDE_NAMES:
        knuckles = [landmarks.body[f"{side}{name}"] for name in KNUCKLE_LANDMARKS if f"{side}{name}" in landmarks.body]
        if len(knuckles) == len(KNUCKLE_LANDMARKS):
            found.append(np.asarray(np.mean(knuckles, axis=0), np.float64))
    return found


def _floor_around(legs: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2, 3) opposite corners of the floor that is looked at."""
    middle = legs.mean(0) * [1, 0, 1]
    away = np.array([FLOOR_REACH_METRES, 0, FLOOR_REACH_METRES])
    return np.stack([middle - away, middle + away])


def _about_legs(frame: FootFrame, legs: NDArray[np.float64], hands: Sequence[NDArray[np.float64]]) -> _Legs | None:
    """The part of a frame about those legs (6, 3), but for what is about `hands` (3,); None where it shows none of them."""
    if frame.person.depth(legs).min() < MIN_DEPTH_METRES:
        return None
    pixels_per_metre = frame.person.focal / float(frame.person.depth(legs.mean(0)))
    corners = frame.person.project(legs, np.float64)[:, :2]
    area = np.zeros(frame.mask.shape, np.uint8)
    cv2.fillConvexPoly(area, cv2.convexHull(np.rint(corners).astype(np.int32)), 1)
    near = dilate_mask(area > 0, round(LEG_REACH_METRES * pixels_per_metre)) & frame.mask
    for hand in hands:
        away = float(frame.person.depth(hand[None])[0])
        if away > MIN_DEPTH_METRES:
            at = frame.person.project(hand[None], np.float64)[:, :2]
            near &= ~near_lines(near.shape, at[None].repeat(2, 1), HAND_BLANK_METRES * frame.person.focal / away)
    if not near.any():
        return None
    rows, columns = (np.flatnonzero(near.any(axis)) for axis in (1, 0))
    part = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    return _Legs(*part, near[part], pixels_per_metre)


def _colours_before_floor(
    frames: Sequence[FootFrame], parts: Sequence[_Legs | None], floor: FloorMosaic
) -> ColourMixture | None:
    """The colours of legs and what hangs about them, in the floor's exposure: of what is surely not the floor behind it."""
    seen = []
    for frame, part, gain in zip(frames, parts, floor.gains, strict=True):
        if part is None:
            continue
        image, camera = _cropped(frame, part)
        inner = part.area & (distance_inside(frame.mask)[part.rows, part.columns] > INNER_PIXELS)
        seen.append(image[inner & (floor.deviations(image, gain, camera) > MIN_STRANGER_SIGMAS)] / gain)
    colours = np.concatenate(seen) if seen else np.zeros((0, 3))
    return ColourMixture.fit(colours) if len(colours) >= MIN_MIXTURE_PIXELS else None


def _gaps(
    frame: FootFrame, part: _Legs, floor: FloorMosaic, person: ColourMixture, gain: NDArray[np.floating]
) -> NDArray[np.bool_]:
    """(h, w) what of a mask about legs is the floor."""
    image, camera = _cropped(frame, part)
    asked = part.area & np.isfinite(floor.seen_by(camera)[..., 0])
    lost = np.zeros(asked.shape, np.bool_)
    if not asked.any():
        return lost
    of_floor = floor.cost(image, gain, camera)[asked]
    of_person = cost_among_strange(np.exp(-person.negative_log_likelihood(image[asked] / gain)))
    graph = ContrastGraph.of(image.astype(np.float64), asked)
    costs = np.stack([of_floor + MASK_COST, of_person], 1)
    lost[asked] = graph.cut(costs, np.ones(len(costs), np.intp)) == 0
    lost = without_small_pieces(lost, (MIN_GAP_METRES * part.pixels_per_metre) ** 2)
    return lost if np.count_nonzero(lost) <= MAX_GAP_SHARE * np.count_nonzero(part.area) else np.zeros_like(lost)


def _cropped(frame: FootFrame, part: _Legs) -> tuple[NDArray[np.uint8], Camera]:
    """The part of a frame's picture, and the room's camera of that."""
    image = frame.image[part.rows, part.columns]
    return image, frame.room.cropped(part.columns.start, part.rows.start, (image.shape[0], image.shape[1]))
