"""The back of a head: hair, or whatever else surrounds the face, down to the nape, and the neck below.

What is hair is found by where it is (around the face's oval, above the chin, well inside the mask) and by its colour, if
that can be told from the skin's. It is copied to where the face and the ears were, patch by patch.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.texture.far_cheek import with_far_cheek
from engine.character.texture.head_area import Head, measure_head
from engine.imaging.filling.inpaint import inpaint
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.masks.mask_distance import distance_to
from engine.imaging.masks.mask_pieces import bounding_box, pieces_touching

MAX_HEAD_COLOUR_DISTANCE = 20.0
"""Distance of two colours (CIE Lab, 8 bits) below which they may be of one thing."""
MIN_HAIR_SHARE = 0.02
"""Share of a head from which the rest can be filled."""
BROW_LEVEL = 0.35
"""How far above the face's middle the brows are, as a share of the way to its top: what is beside the oval from here on is
hair or a hat; below, it may be an ear."""
MIN_BESIDE_FACE_HALF_AXES = 1.06
"""From how far out, in half axes of the face's oval, a pixel is not the face's."""
NAPE_LEVEL = 0.55
"""How far below the face's middle the hair reaches at the back, as a share of the way to the chin."""
LONG_HAIR_LEVEL, MIN_LONG_HAIR_SHARE = -0.6, 0.011
"""Which share of the head must be hair this far below the face's middle, if hair is long, and hides the neck from behind."""
HANGING_HAIR_LEVEL, HANGING_HAIR_WIDTH_RATIO, HANGING_HAIR_EVIDENCE_FACTOR = -0.8, 1.3, 0.5
"""Where a head that is so much wider than its face has hair that hangs; less of it must be seen there, by this factor."""
MIXED_BAND_PIXELS = 2.0
"""Pixels of the grid from the outline inward that may show what is behind the person."""
SIDEBURN_LEVEL = -0.4
"""How far below the face's middle hair that is none of a beard's or a coat's colour begins, at the lowest."""
CROWN_DEPTH_PIXELS = 4.0
"""How far inward from the outline, pixels of the grid, hair surely reaches above the brows."""
MIN_UNLIKE_FACE_SHARE = 0.6
"""Share of what is along the outline above the brows that must differ from the face, if what does not is taken for a
high forehead."""
TYPICAL_COLOUR_COUNT = 4
"""Colours that stand for all of a face's, or of hair's."""
MIN_HANGING_SHARE = 0.3
"""Share of hair that is above the chin, if it is hair that hangs down."""
DARKEST_FACE_SHARE = 0.4
"""Share of a face that may be beard, brows, spectacles or their shadow, and so has hair's colours."""
HAIR_COLOUR_RATIO = 0.7
"""How much nearer to hair than to skin a colour must be."""
MAX_BACKGROUND_SHARE, BACKGROUND_SHARE_SLOPE, BACKGROUND_BAND_PIXELS = 0.2, 0.1, 8.0
"""How much of a colour at the outline may be the background's, how much more for each pixel of the grid inward, where
that is less likely, and how far inward it is not possible."""
HAIR_MID_LEVEL = 128.0
"""The level on which what is fine about hair is looked at."""
FULL_STRAND_COVERAGE, MIN_STRAND_COVERAGE = 0.1, 0.3
"""How much hair must be seen, as a share of what is to be covered, or patches of it repeat. They are shown more
faintly, the less there is, and not at all below this share of that."""
LONG_STRAND_PIXELS, SHORT_STRAND_PIXELS, STRAND_CONTRAST_FACTOR = (0.3, 3.0), (0.25, 1.2), 0.7
"""Width and length of a streak, pixels of the grid, and how much fainter it is than what is seen of hair."""
DISTANCE_DECAY = 0.3
"""How much less colours of twice the distance count."""
NAPE_ROUNDING_SHARE, NAPE_UNEVENNESS_PIXELS = 0.15, 3.0
"""How much lower than at the sides hair ends in the middle of the nape, as a share of the way to the chin; and how
uneven its end is, pixels of the grid."""
MEDIAN_WEIGHT = 0.003
"""How much the median of all colours counts beside those nearby."""
NAPE_BLEND_PIXELS = 3.0
"""Pixels of the grid over which hair ends at the nape."""


def back_of_the_head(
    rgb: NDArray[np.uint8],
    seen: NDArray[np.uint8],
    covered: NDArray[np.bool_],
    own: NDArray[np.bool_],
    mask: NDArray[np.bool_],
    face: NDArray[np.floating],
    turned: float,
    scale: float,
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """The picture (h, w, 3) with the back of the head in the head's place; and the front (h, w, 3) that this joins at the
    outline, without what shines through hair there.

    Parameters
    ----------
    rgb : the person's colours; `seen` (h, w, 3): the picture with what is behind them.
    covered, own, mask : (h, w) where the person is at all, where the colours are all their own, and where the head is.
    face : its oval, as centre x and y, half axes, and degrees by which it is tilted.
    turned : to which side it looks, as `face_region.face_turn` says.
    scale : pixels for each of the grid's.
    """
    margin = round(BACKGROUND_BAND_PIXELS * scale)
    box = bounding_box(mask, margin)
    back, front = rgb.copy(), rgb.copy()
    oval = face - np.array([box[1].start, box[0].start, 0, 0, 0])
    head = measure_head(own[box], mask[box], oval, scale)
    around = beyond_the_outline(seen[box], covered[box])
    hair, through = find_hair(rgb[box], around, head)
    hair = hair if hair.any() else _beside_the_oval(head)
    if hair.any():
        found = _back(rgb[box], hair, head, float(oval[3]))
        back[box] = with_far_cheek(found, rgb[box], hair, head, float(oval[2]), turned)
        front[box] = np.where(through[..., None], back[box], rgb[box])
    return back, front


def _beside_the_oval(head: Head) -> NDArray[np.bool_]:
    """The pixels (h, w) of a head without hair, as one that the picture cuts off: what surrounds its face, or what is along its
    outline where that is no more than a rim."""
    beside = head.mask & (head.out > MIN_BESIDE_FACE_HALF_AXES)
    if beside.sum() > MIN_HAIR_SHARE * head.mask.sum():
        return beside
    return head.mask & (head.depth < CROWN_DEPTH_PIXELS)


def _back(rgb: NDArray[np.uint8], hair: NDArray[np.bool_], head: Head, high: float) -> NDArray[np.uint8]:
    """The head from behind in the part of the picture (h, w, 3) that shows it; a face is `high` half its height,
    pixels."""
    nape = nape_height(hair, head)
    noise = np.random.default_rng(0).normal(size=hair.shape).astype(np.float32)
    uneven = NAPE_UNEVENNESS_PIXELS * head.scale**2 / high * cv2.GaussianBlur(noise, (0, 0), head.scale)
    line = nape + NAPE_ROUNDING_SHARE * (np.minimum(head.out**2 - head.up**2, 1) - 1) + uneven
    share = np.clip((head.up - line) * high / (NAPE_BLEND_PIXELS * head.scale) + 0.5, 0, 1)[..., None]
    neck = _neck(rgb, hair, head, nape)
    back = neck + share * (_covered(rgb, hair, head, nape < -1) - neck)
    return np.where(head.mask[..., None], np.clip(back + 0.5, 0, 255), rgb).astype(np.uint8)


def find_hair(
    rgb: NDArray[np.uint8], around: NDArray[np.uint8], head: Head
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """The pixels (h, w) of the head that surely show hair, a hat or a hood, and those (h, w) where what is behind the
    person is seen through hair. Hair is what is along the outline above the brows, and what has its colours rather than
    the face's or those behind the person."""
    colours = cv2.cvtColor(cv2.GaussianBlur(rgb, (0, 0), 1.5), cv2.COLOR_RGB2LAB).astype(np.float32)
    behind = cv2.cvtColor(around, cv2.COLOR_RGB2LAB).astype(np.float32)
    face = head.mask & (head.out < 0.7)
    inside = head.mask & (head.out > MIN_BESIDE_FACE_HALF_AXES) & (head.depth > MIXED_BAND_PIXELS)
    crown = inside & (head.up > BROW_LEVEL)
    sample = crown & (head.depth < MIXED_BAND_PIXELS + CROWN_DEPTH_PIXELS)
    if sample.sum() < 8 or face.sum() < 8:
        return sample, np.zeros_like(sample)
    skin = face & (colours[..., 0] >= np.quantile(colours[face][:, 0], DARKEST_FACE_SHARE))
    other = sample & (_distance(colours, sample, colours[skin]) > MAX_HEAD_COLOUR_DISTANCE)
    if other.sum() > MIN_UNLIKE_FACE_SHARE * sample.sum():
        sample = other
    contrast = np.linalg.norm(colours - behind, axis=-1)
    hair = np.median(colours[sample & (contrast >= np.median(contrast[sample]))], axis=0)
    mixed = _mixed(colours, behind, hair, head)
    own = inside & ~mixed
    if (sample & own).sum() >= 8:
        sample &= own
    from_skin, from_hair = (_distance(colours, head.mask, colours[where]) for where in (skin, sample))
    found = sample | (own & (from_hair < np.minimum(HAIR_COLOUR_RATIO * from_skin, 1.5 * MAX_HEAD_COLOUR_DISTANCE)))
    found = _beside_the_face(found, sample, head)
    found |= own & ~pieces_touching(~found, face | ~head.mask)  # a lock that shines, within
    safe = cv2.erode(found.astype(np.uint8), np.ones((3, 3), np.uint8), iterations=max(1, round(head.scale))) > 0
    beside = distance_to(found) < CROWN_DEPTH_PIXELS * head.scale
    through = head.mask & mixed & (from_skin > MAX_HEAD_COLOUR_DISTANCE) & beside
    return (safe if safe.sum() > max(8.0, MIN_HAIR_SHARE * head.mask.sum()) else found), through


def _distance(colours: NDArray[np.float32], where: NDArray[np.bool_], of: NDArray[np.float32]) -> NDArray[np.float32]:
    """How far colours (h, w, 3) are from the nearest of a few that are typical `of` others (N, 3); infinite except `where`."""
    criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 10, 1.0)
    few = np.ascontiguousarray(of[:: max(1, len(of) // 2000)])
    cv2.setRNGSeed(0)
    start = np.zeros((len(few), 1), np.int32)
    _, _, typical = cv2.kmeans(few, min(TYPICAL_COLOUR_COUNT, len(few)), start, criteria, 1, cv2.KMEANS_PP_CENTERS)
    away = np.full(colours.shape[:2], np.inf, np.float32)
    away[where] = np.linalg.norm(colours[where][:, None] - typical[None], axis=-1).min(1)
    return away


def _beside_the_face(found: NDArray[np.bool_], sample: NDArray[np.bool_], head: Head) -> NDArray[np.bool_]:
    """The pieces of what is `found` (h, w) that hold some of the `sample` (h, w), or hang down beside the face: a coat
    may have the colour of hair, but is below the chin."""
    count, pieces = cv2.connectedComponents(found.astype(np.uint8), connectivity=8)
    numbers = pieces[found].astype(np.intp)
    sizes = np.bincount(numbers, minlength=count)
    above = np.bincount(numbers, head.up[found] > -1, minlength=count)
    highest = np.full(count, -np.inf)
    np.maximum.at(highest, numbers, head.up[found])
    kept = (above > MIN_HANGING_SHARE * sizes) & (highest > SIDEBURN_LEVEL)
    kept[np.unique(pieces[sample & found])] = True
    return found & kept[pieces]


def _mixed(
    colours: NDArray[np.float32], behind: NDArray[np.float32], hair: NDArray[np.floating], head: Head
) -> NDArray[np.bool_]:
    """The pixels (h, w) near the outline whose colour is partly that of what is `behind` them, nearest beside the person."""
    way = behind - hair
    long = (way**2).sum(-1)
    share = ((colours - hair) * way).sum(-1) / np.maximum(long, 1e-6)
    return np.asarray(
        (share > MAX_BACKGROUND_SHARE + BACKGROUND_SHARE_SLOPE * head.depth)
        & (long > MAX_HEAD_COLOUR_DISTANCE**2)
        & (head.depth < BACKGROUND_BAND_PIXELS)
    )


def _covered(rgb: NDArray[np.uint8], hair: NDArray[np.bool_], head: Head, long: bool) -> NDArray[np.float32]:
    """The head (h, w, 3) all over with hair. Colours hardly change, and are interpolated. On them is, patch by patch,
    what is fine about hair, or where little of it is seen, streaks. Patches alone would carry on whatever shade a
    little hair has at its edge."""
    shade = _interpolated(rgb, hair, head.scale)
    fine = np.clip(HAIR_MID_LEVEL + rgb.astype(np.float32) - shade, 0, 255).astype(np.uint8)
    hole = head.mask & ~hair
    whole = float(cv2.erode(hair.astype(np.uint8), np.ones((7, 7), np.uint8)).sum())
    strength = min(1.0, whole / max(FULL_STRAND_COVERAGE * hole.sum(), 1.0))
    spread = np.abs(fine[hair].astype(np.float32) - HAIR_MID_LEVEL).mean()
    drawn = (
        STRAND_CONTRAST_FACTOR
        * np.sqrt(1 - strength**2)
        * spread
        * _strands(hair.shape, head.scale, LONG_STRAND_PIXELS if long else SHORT_STRAND_PIXELS)[..., None]
    )
    if strength > MIN_STRAND_COVERAGE:
        drawn = drawn + strength * (inpaint(fine, hole, hair).astype(np.float32) - HAIR_MID_LEVEL)
    return np.where(hair[..., None], rgb, shade + drawn).astype(np.float32)


def _strands(shape: tuple[int, ...], scale: float, size: tuple[float, float]) -> NDArray[np.float32]:
    """What hair that hangs down looks like from far, (h, w): streaks around 0, of a deviation of 1."""
    noise = np.random.default_rng(1).normal(size=shape).astype(np.float32)
    streaks = np.asarray(cv2.GaussianBlur(noise, (0, 0), sigmaX=size[0] * scale, sigmaY=size[1] * scale), np.float32)
    return streaks / max(float(streaks.std()), 1e-6)


def _interpolated(rgb: NDArray[np.uint8], known: NDArray[np.bool_], scale: float) -> NDArray[np.float32]:
    """Colours (h, w, 3) that are the means of what is `known` (h, w) nearby, and where nothing is, of what is farther."""
    rows, columns = bounding_box(known)
    step = max(1, round(scale))
    small = (max(1, rgb.shape[1] // step), max(1, rgb.shape[0] // step))
    weight = cv2.resize(known.astype(np.float32), small, interpolation=cv2.INTER_AREA)
    total = cv2.resize(np.where(known[..., None], rgb, 0).astype(np.float32), small, interpolation=cv2.INTER_AREA)
    most = 0.5 * (max(rows.stop - rows.start, columns.stop - columns.start) - 1) / step
    weights = np.full_like(weight, MEDIAN_WEIGHT)
    sums = np.zeros_like(total) + MEDIAN_WEIGHT * np.median(rgb[known], axis=0).astype(np.float32)
    for sigma in np.geomspace(2.0, max(most, 2.1), 4):
        share = DISTANCE_DECAY ** float(np.log2(sigma))
        sums += share * cv2.GaussianBlur(total, (0, 0), float(sigma))
        weights += share * cv2.GaussianBlur(weight, (0, 0), float(sigma))
    return np.asarray(cv2.resize(sums / weights[..., None], rgb.shape[1::-1], interpolation=cv2.INTER_LINEAR))


def nape_height(hair: NDArray[np.bool_], head: Head) -> float:
    """How far above the face's middle (below 0) the hair ends at the back."""
    least = MIN_LONG_HAIR_SHARE * head.mask.sum()
    if (
        head.width_at(HANGING_HAIR_LEVEL) > HANGING_HAIR_WIDTH_RATIO
    ):  # what hangs there is hardly told from skin where it is fair
        least *= HANGING_HAIR_EVIDENCE_FACTOR
    long = (hair & (head.up < LONG_HAIR_LEVEL)).sum() > least
    return float(head.up[head.mask].min()) - 1 if long else -NAPE_LEVEL


def _neck(rgb: NDArray[np.uint8], hair: NDArray[np.bool_], head: Head, nape: float) -> NDArray[np.float32]:
    """The head (h, w, 3) without face and hair: the neck and what is worn there, and over the rest, what is beside it."""
    below = head.mask & (head.up < nape + 0.2)
    hidden = below & (head.out < MIN_BESIDE_FACE_HALF_AXES)
    bare = below & ~hidden & ~hair
    if bare.sum() < MIN_HAIR_SHARE * head.mask.sum():
        face = head.mask & (head.out < 0.7)
        skin = np.median(rgb[face if face.any() else hair], axis=0)
        return np.where(hidden[..., None], skin, rgb).astype(np.float32)
    return inpaint(rgb, below & ~bare, bare).astype(np.float32)


def beyond_the_outline(rgb: NDArray[np.uint8], person: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """The picture (h, w, 3) with what is behind the person (h, w) in the colours nearest beside them."""
    if person.all() or not person.any():
        return rgb
    soft = np.asarray(cv2.GaussianBlur(rgb[nearest_in(~person)], (0, 0), 3.0))
    return np.where(person[..., None], soft, rgb).astype(np.uint8)
