"""Where photographs show the face's own skin, and not the hair, caps, hands or surroundings that lie on it or beside it.

What comes over a face comes from around it. Two mixtures of colours are learnt of each photograph: one of its cheeks,
nose and chin, and one of what lies about the face's oval and is not of those colours (ears and neck are). A cut between
them, which follows contrast, tells how far the surroundings reach into the face. It asks no other photograph: hair that
falls on the forehead in most of them is hair in each.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.pull_push import pull_push
from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    colour_costs,
)
from engine.imaging.masks.mask_pieces import pieces_touching
from engine.perception.face.landmarks import BROW_POINTS, LEFT_EYE, LIPS_INNER, LIPS_OUTER, RIGHT_EYE, fiducials
from engine.persona.texture.aligned_photos import AlignedPhotos
from engine.persona.texture.texture_frame import TextureFrame

MAP_WIDTH_PIXELS = 72
"""Pixels of the pictures in which skin is told from what is not."""
LIGHT_VARIANCE = 9.0
"""Levels squared (CIE Lab) that both mixtures are widened by: the same matter in another light."""
SKIN_QUANTILE = 0.95
"""Of skin's own colours: what is about the face is skin, too, if it is as likely to be as these."""
UNLIKE_COLOUR_COST = 20.0
"""Of a colour that is quite unlike."""
FEATURE_MARGIN, RIM_MARGIN, CENTRE_MARGIN = 0.035, 0.02, 0.105
"""Shares of the frame's width. The first is the margin about eyes, brows and lips, which have no skin's colour. The
second, beyond the oval, is where the surroundings begin. The third, within it, is where the middle of the face
begins."""
FEATHER_SIGMA_WIDTHS = 0.015
"""Of the frame's width: sigma by which the border is softened, and how far it is set back before."""


def bared(frame: TextureFrame, photos: AlignedPhotos) -> AlignedPhotos:
    """Photographs as they would be without what covers the skin: there they are continued from their own skin, smoothly, and show nothing.
    So are what their heads turn away and what is beside the frame's face."""
    shown = photos.shown * BareSkin(frame)(photos.colours)
    colours = np.empty_like(photos.colours)
    for target, own, weight in zip(colours, photos.colours, shown, strict=True):
        target[:] = np.clip(np.rint(pull_push(own, weight)), 0, 255)
    return AlignedPhotos(colours, shown)


@dataclass(frozen=True)
class BareSkin:
    """Tells it of photographs laid on a `frame`."""

    frame: TextureFrame

    def __call__(self, colours: Sequence[NDArray[np.uint8]] | NDArray[np.uint8]) -> NDArray[np.float32]:
        """(N, H, W) in [0, 1], how far each pixel of photographs (N, H, W, 3) is the face's own; zero beside its oval."""
        with ThreadPoolExecutor(os.cpu_count() or 1, thread_name_prefix="skin") as pool:
            return np.array(list(pool.map(self.of, colours)), np.float32)

    def of(self, colours: NDArray[np.uint8]) -> NDArray[np.float32]:
        """(H, W) the same of one photograph (H, W, 3)."""
        height, width = self.frame.size
        covered = self._surroundings(colours).astype(np.uint8)
        finer = cv2.resize(covered * np.float32(255), (width, height), interpolation=cv2.INTER_LINEAR)
        reach, sigma = round(2 * FEATHER_SIGMA_WIDTHS * width), FEATHER_SIGMA_WIDTHS * width
        grown = cv2.dilate((np.asarray(finer) > 127).astype(np.float32), np.ones((2 * reach + 1,) * 2))
        return np.asarray((1 - np.asarray(cv2.GaussianBlur(grown, (0, 0), sigma))) * self.frame.face, np.float32)

    def _surroundings(self, colours: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """(h, w) where what is about the face covers it, in the coarse frame."""
        area, skin, around, middle, brow = self._areas
        small = cv2.resize(colours, area.shape[::-1], interpolation=cv2.INTER_AREA)
        lab = np.asarray(cv2.cvtColor(small.astype(np.float32) / 255, cv2.COLOR_RGB2LAB), np.float32)
        skins = ColourMixture.fit(lab[skin]).widened(LIGHT_VARIANCE)
        usual = np.quantile(skins.negative_log_likelihood(lab[skin]), SKIN_QUANTILE)
        others = lab[around][skins.negative_log_likelihood(lab[around]) > usual]
        if len(others) < MIN_MIXTURE_PIXELS:  # all about the face is skin
            return np.zeros(area.shape, np.bool_)
        mixtures = (skins, ColourMixture.fit(others).widened(LIGHT_VARIANCE))
        costs = np.minimum(colour_costs(mixtures, lab[area]), UNLIKE_COLOUR_COST)
        costs[brow[area]] = 0  # of hair's colour, they go with what is about them
        seeds = np.where(middle[area], 0, UNSEEDED_MARK)
        labels = ContrastGraph.of(lab, area).cut(costs, np.zeros(len(costs), np.intp), seeds)
        found = np.zeros(area.shape, np.bool_)
        found[area] = labels == 1
        return pieces_touching(found, around)

    @cached_property
    def _areas(self) -> tuple[NDArray[np.bool_], ...]:
        """Areas of the coarse frame (h, w): what the frame covers, skin for certain, what is about the face above the
        mouth, the middle of the face from the brows down, and the brows."""
        frame, (height, width) = self.frame, self.frame.size
        places = frame.places[:478, :2]
        brows = np.split(fiducials(frame.places[:478])[BROW_POINTS, :2], 2)
        hairy = _grown(_hulls(brows, frame.size), FEATURE_MARGIN * width)
        features = _hulls([places[list(one)] for one in (LEFT_EYE, RIGHT_EYE, LIPS_OUTER)], frame.size)
        features = hairy | _grown(features, FEATURE_MARGIN * width)
        rows = np.arange(height)[:, None]
        middle = 1 - _grown(1 - frame.face.astype(np.uint8), CENTRE_MARGIN * width)
        middle *= rows > min(float(brow[:, 1].min()) for brow in brows)
        beyond = frame.covered & (_grown(frame.face.astype(np.uint8), RIM_MARGIN * width) == 0)
        around = beyond & (rows < places[list(LIPS_INNER), 1].mean())
        size = MAP_WIDTH_PIXELS, round(height * MAP_WIDTH_PIXELS / width)
        return tuple(
            cv2.resize(one.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST) > 0
            for one in (frame.covered, middle * (1 - features), around, middle, hairy)
        )


def _hulls(outlines: Sequence[NDArray[np.floating]], size: tuple[int, int]) -> NDArray[np.uint8]:
    out = np.zeros(size, np.uint8)
    for outline in outlines:
        cv2.fillConvexPoly(out, cv2.convexHull(np.rint(outline).astype(np.int32)), 1)
    return out


def _grown(mask: NDArray[np.uint8], reach: float) -> NDArray[np.uint8]:
    return np.asarray(cv2.dilate(mask, np.ones((2 * round(reach) + 1,) * 2)), np.uint8)
