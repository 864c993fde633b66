"""The mask of the people in a picture, soft at hair and sharp at cloth, at the picture's own resolution.

Two networks look first: MediaPipe's selfie segmentation (256 px; on the whole picture, mirrored, and
again on the part that holds a person) and the mask that comes with its body pose. Neither sees edges
finely, but they miss different things. Where they agree the matter is settled; where they do not,
colours decide (GrabCut); and along the outline an alpha matte is solved (`engine.imaging.alpha_matte`).
"""

from __future__ import annotations

import cv2
import mediapipe as mp
import numpy as np
from numpy.typing import NDArray

from engine.imaging.alpha_matte import alpha_matte
from engine.imaging.resample import resized, size_within

WORKING_SIZE = 800
"""Longest side, in pixels, at which the matte is solved; larger pictures get it by guided upsampling."""

CUT_SIZE = 320
"""Longest side at which colours decide between the networks."""

BAND = 0.035
"""Half width of the band in which the matte is free, as a share of the square root of the person's area."""


def person_mask(
    rgb: NDArray[np.uint8],
    seed: NDArray[np.float32] | None = None,
    alpha: NDArray[np.uint8] | NDArray[np.float32] | None = None,
) -> NDArray[np.float32]:
    """Soft mask (H, W) in [0, 1] of the people in a picture; all zero where nobody is seen.

    Parameters
    ----------
    rgb : (H, W, 3) uint8.
    seed : (H, W) float32, 1 where a person is known to be (a face's region): helps in drawings, where
        the networks see little.
    alpha : (H, W), the picture's own alpha channel (uint8, or float in [0, 1]). Where it cuts something
        out it is taken as the truth; a channel that is opaque throughout says nothing.
    """
    if alpha is not None:
        channel = alpha.astype(np.float32) / np.float32(255 if alpha.dtype == np.uint8 else 1)
        if np.mean(channel < 0.5) > 0.01:
            return channel
    small = resized(np.ascontiguousarray(rgb), size_within(rgb.shape, WORKING_SIZE))
    size = (small.shape[1], small.shape[0])
    low, high = network_masks(small)
    if seed is not None:
        known = resized(seed, size)
        low, high = np.maximum(low, known), np.maximum(high, known)
    cut = settle_by_colour(small, low, high)
    matte = refine_outline(small, cut, low, high)
    return matte if small.shape == rgb.shape else upsample_guided(matte, small, rgb)


def network_masks(rgb: NDArray[np.uint8]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The least and the most, (H, W) in [0, 1] each, that the networks believe to be a person."""
    masks = _selfie_masks(rgb)
    posed = _pose_mask(rgb)
    selfie = np.mean(masks, axis=0)
    if posed is None:
        return np.min(masks, axis=0), np.max(masks, axis=0)
    return np.minimum(selfie, posed), np.maximum(selfie, posed)


def _selfie_masks(rgb: NDArray[np.uint8]) -> list[NDArray[np.float32]]:
    height, width = rgb.shape[:2]
    with mp.solutions.selfie_segmentation.SelfieSegmentation(model_selection=0) as network:

        def look(part: NDArray[np.uint8]) -> NDArray[np.float32]:
            straight = network.process(np.ascontiguousarray(part)).segmentation_mask
            mirrored = network.process(np.ascontiguousarray(part[:, ::-1])).segmentation_mask[:, ::-1]
            return (straight + mirrored) / 2

        whole = look(rgb)
        ys, xs = np.nonzero(whole > 0.5)
        if len(ys) < 16:
            return [whole]
        margin = 0.15 * max(np.ptp(ys), np.ptp(xs)) + 4
        top, bottom = max(0, int(ys.min() - margin)), min(height, int(ys.max() + margin))
        left, right = max(0, int(xs.min() - margin)), min(width, int(xs.max() + margin))
        if (bottom - top) * (right - left) > 0.7 * height * width:
            return [whole]
        closer = np.zeros_like(whole)
        closer[top:bottom, left:right] = look(rgb[top:bottom, left:right])
        return [whole, closer]


def _pose_mask(rgb: NDArray[np.uint8]) -> NDArray[np.float32] | None:
    with mp.solutions.pose.Pose(static_image_mode=True, model_complexity=1, enable_segmentation=True) as network:
        mask = network.process(np.ascontiguousarray(rgb)).segmentation_mask
    return None if mask is None else np.asarray(mask, np.float32)


def settle_by_colour(
    rgb: NDArray[np.uint8], low: NDArray[np.float32], high: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Person or not, (H, W) float32 0 or 1: GrabCut where the networks are unsure or disagree."""
    size = size_within(low.shape, CUT_SIZE)
    small, least, most = resized(rgb, size), resized(low, size), resized(high, size)
    labels = np.where((least + most) / 2 > 0.5, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    labels[(least > 0.8) & (most > 0.95)] = cv2.GC_FGD
    labels[most < 0.1] = cv2.GC_BGD
    sure = (labels == cv2.GC_FGD).any() and (labels == cv2.GC_BGD).any()
    if not sure:
        return (((low + high) / 2) > 0.5).astype(np.float32)
    cv2.setRNGSeed(1)
    no_box = (0, 0, 0, 0)
    cv2.grabCut(small.copy(), labels, no_box, np.zeros((1, 65)), np.zeros((1, 65)), 3, cv2.GC_INIT_WITH_MASK)
    person = np.isin(labels, (cv2.GC_FGD, cv2.GC_PR_FGD)).astype(np.float32)
    return (resized(person, (low.shape[1], low.shape[0])) > 0.5).astype(np.float32)


def refine_outline(
    rgb: NDArray[np.uint8], cut: NDArray[np.float32], low: NDArray[np.float32], high: NDArray[np.float32]
) -> NDArray[np.float32]:
    """The cut with its outline solved as an alpha matte."""
    if not cut.any() or cut.all():
        return cut
    band = max(3.0, BAND * float(np.sqrt(cut.sum())))
    inside = cv2.distanceTransform((cut > 0.5).astype(np.uint8), cv2.DIST_L2, 5)
    outside = cv2.distanceTransform((cut <= 0.5).astype(np.uint8), cv2.DIST_L2, 5)
    signed = inside - outside
    trimap = np.where(signed > band * 0.7, 1.0, np.where(signed < -band, 0.0, 0.5)).astype(np.float32)
    away = np.clip(np.abs(signed) / band, 0, 1)
    prior = (signed > 0).astype(np.float32)
    return alpha_matte(rgb, trimap, prior, (0.01 * away**2).astype(np.float32))


def upsample_guided(
    matte: NDArray[np.float32], small: NDArray[np.uint8], rgb: NDArray[np.uint8]
) -> NDArray[np.float32]:
    """The matte of a small picture at the size of the full one, its edges following the full one's.

    Guided filter (He, Sun, Tang, PAMI 2013) in its fast form: the local affine model from colour to
    alpha is fitted on the small picture and applied to the full one.
    """
    height, width = rgb.shape[:2]
    guide = small.astype(np.float32) / np.float32(255)
    slope, offset = _affine_models(guide, matte, radius=2, noise=1e-4)
    fine = (resized(slope, (width, height)) * rgb).sum(-1) / 255 + resized(offset, (width, height))
    plain = resized(matte, (width, height))
    settled = (plain <= 0) | (plain >= 1)
    return np.where(settled, plain, np.clip(fine, 0, 1)).astype(np.float32)


def _affine_models(
    guide: NDArray[np.float32], alpha: NDArray[np.float32], radius: int, noise: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Slopes (H, W, 3) and offsets (H, W) of alpha as an affine function of the colour around each pixel."""
    side = (2 * radius + 1, 2 * radius + 1)

    def mean(values: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.asarray(cv2.blur(values, side), np.float32)

    colour, level = mean(guide), mean(alpha)
    cross = mean(guide * alpha[..., None]) - colour * level[..., None]
    products = mean(np.stack([guide[..., i] * guide[..., j] for i in range(3) for j in range(3)], -1))
    spread = products.reshape(*alpha.shape, 3, 3) - colour[..., :, None] * colour[..., None, :]
    slope = np.linalg.solve(spread + noise * np.eye(3, dtype=np.float32), cross[..., None])[..., 0]
    offset = level - np.einsum("ijk,ijk->ij", slope, colour)
    return mean(slope.astype(np.float32)), mean(offset.astype(np.float32))
