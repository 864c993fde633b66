"""The actor's skin, painted: blood and melanin, lips, lids, beard shadow, pores, gloss.

Colour follows how skin comes by it: a pale ground, dimmed by two pigments that absorb each colour differently,
haemoglobin (blush, lips, lids) and melanin (tan, freckles, shadows under the eyes). Places are chart metres.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.performances.modelling.brows import BROW_LINE
from engine.performances.modelling.chart import (
    CHART_LEFT,
    CHART_SHAPE,
    CHART_TEXELS_PER_METRE,
    CHART_TOP,
    blob,
    curve_coordinates,
    grid,
    mirrored_blobs,
    noise,
    slopes,
    smooth_curve,
    smooth_step,
)

BASE_REFLECTANCE = np.array([0.72, 0.52, 0.42], np.float32)
"""Diffuse reflectance (linear RGB) of the skin with hardly any pigment."""

BLOOD_ABSORBANCE = np.array([0.14, 0.78, 0.66], np.float32)
MELANIN_ABSORBANCE = np.array([0.26, 0.50, 0.78], np.float32)
"""Absorbance of one unit of pigment in red, green and blue: after the spectra in T. Igarashi et al., The
Appearance of Human Skin, 2007, in the proportions that matched photographs by eye."""

UPPER_LIP_BORDER = [(-0.0236, 0.7213), (-0.0175, 0.7252), (-0.0105, 0.7286), (-0.0052, 0.7312), (0.0, 0.7300)]
LOWER_LIP_BORDER = [(-0.0236, 0.7213), (-0.0185, 0.7158), (-0.0115, 0.7116), (-0.0055, 0.7097), (0.0, 0.7093)]
"""The right half of the lips' border, from the corner of the mouth to the middle."""


@dataclass(frozen=True)
class Skin:
    """Maps over the chart.

    albedo : (H, W, 3) linear.
    height : (H, W) metres of fine relief.
    roughness : (H, W).
    lips : (H, W) in [0, 1].
    maps : (H, W, 6) albedo, roughness, and the relief's slopes along u and v, as one texture.
    """

    albedo: NDArray[np.float32]
    height: NDArray[np.float32]
    roughness: NDArray[np.float32]
    lips: NDArray[np.float32]
    maps: NDArray[np.float32]


def paint_skin(seed: int = 7) -> Skin:
    """Paint the actor's skin."""
    rng = np.random.default_rng(seed)
    lips = _lips(rng)
    blood = _blood(rng) * (1 - lips) + lips * (0.74 + 0.08 * noise(rng, 0.0016) + 0.07 * noise(rng, 0.006))
    melanin = _melanin(rng) * (1 - lips) + lips * 0.40
    albedo = BASE_REFLECTANCE * np.exp(-blood[..., None] * BLOOD_ABSORBANCE - melanin[..., None] * MELANIN_ABSORBANCE)
    beard = _beard(rng) * (1 - lips)
    albedo *= 1 - beard[..., None] * np.array([0.40, 0.35, 0.27], np.float32)
    brows = np.clip(1.25 * brow_shadow(), 0, 1)[..., None] * np.array([0.34, 0.40, 0.44], np.float32)
    albedo *= 1 - brows
    pores = _pores(rng)
    relief = 2.6e-5 * pores * (1 - lips) + 1.2e-5 * noise(rng, 0.0011)
    relief = relief + lips * _lip_lines(rng)
    albedo, relief = albedo.astype(np.float32), relief.astype(np.float32)
    roughness = _roughness(rng, lips, beard)
    return Skin(albedo, relief, roughness, lips, np.dstack([albedo, roughness, *slopes(relief)]))


def _lips(rng: np.random.Generator) -> NDArray[np.float32]:
    """The vermilion with its soft, slightly ragged border."""
    upper, lower = smooth_curve(mirrored(UPPER_LIP_BORDER)), smooth_curve(mirrored(LOWER_LIP_BORDER))
    outline = np.concatenate([upper, lower[::-1]])
    texels = np.stack(
        [
            (outline[:, 0] - CHART_LEFT) * CHART_TEXELS_PER_METRE - 0.5,
            (CHART_TOP - outline[:, 1]) * CHART_TEXELS_PER_METRE - 0.5,
        ],
        1,
    )
    inside = np.zeros(CHART_SHAPE, np.uint8)
    cv2.fillPoly(inside, [np.rint(texels * 16).astype(np.int32)], 1, shift=4)
    distance = cv2.distanceTransform(inside, cv2.DIST_L2, 5) - cv2.distanceTransform(1 - inside, cv2.DIST_L2, 5)
    ragged = distance / CHART_TEXELS_PER_METRE + 0.00022 * noise(rng, 0.0018)
    return smooth_step(ragged, -0.0009, 0.0010)


def mirrored(half: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """A curve given from the right to the middle of the face, carried on to the left."""
    return half + [(-u, v) for u, v in reversed(half[:-1])]


def _blood(rng: np.random.Generator) -> NDArray[np.float32]:
    """Haemoglobin: more where vessels lie near the surface, mottled everywhere."""
    flush = (
        0.20 * mirrored_blobs((0.037, 0.757), (0.015, 0.011), -0.5)  # cheeks
        + 0.22 * blob((0.0, 0.756), (0.010, 0.008))  # tip of the nose
        + 0.28 * mirrored_blobs((0.0165, 0.7515), (0.0035, 0.004))  # wings of the nose and the crease behind them
        + 0.10 * blob((0.0, 0.695), (0.014, 0.009))  # chin
        + 0.12 * mirrored_blobs((0.030, 0.7835), (0.013, 0.0035), -0.05)  # lower lids
        + 0.12 * mirrored_blobs((0.031, 0.7985), (0.013, 0.0035), 0.0)  # upper lids
        + 0.22 * mirrored_blobs((0.0185, 0.7885), (0.0022, 0.0024))  # corners of the eyes
        + 0.16 * mirrored_blobs((0.0235, 0.7205), (0.004, 0.004))  # corners of the mouth
        + 0.55 * mirrored_blobs((0.155, 0.772), (0.028, 0.034))  # ears
        + 0.06 * blob((0.0, 0.84), (0.05, 0.02))
    )
    mottle = 0.034 * noise(rng, 0.009, 4) + 0.032 * noise(rng, 0.0022, 2)
    return np.maximum(0.215 + flush + mottle * (1 + 0.8 * flush), 0.02)


def _melanin(rng: np.random.Generator) -> NDArray[np.float32]:
    """Melanin: a light tan, shadows under the eyes, freckles, a few moles."""
    tan = (
        0.05 * blob((0.0, 0.845), (0.06, 0.03))
        + 0.05 * mirrored_blobs((0.05, 0.765), (0.02, 0.015))
        + 0.10 * mirrored_blobs((0.0225, 0.7835), (0.009, 0.0035), -0.35)  # hollow under the eye
        + 0.06 * mirrored_blobs((0.032, 0.7995), (0.014, 0.004))
        - 0.05 * blob((0.0, 0.66), (0.06, 0.03))  # the throat sees no sun
    )
    spots = np.maximum(noise(rng, 0.0016) - 2.3, 0) * (0.4 + mirrored_blobs((0.032, 0.765), (0.02, 0.012)))
    moles = sum(strength * blob(place, (size, size)) for place, size, strength in MOLE_PLACES)
    return np.maximum(0.265 + tan + 0.022 * noise(rng, 0.016, 3) + 0.07 * spots + moles, 0.02)


MOLE_PLACES = (((0.041, 0.7405), 0.00055, 1.1), ((-0.056, 0.7685), 0.0005, 0.9), ((-0.022, 0.6925), 0.0006, 0.7))
"""Place, radius and strength."""


def _beard(rng: np.random.Generator) -> NDArray[np.float32]:
    """The shadow of a shaved beard: where it grows, and the cut hairs in it."""
    u, v = grid()
    side = np.abs(u)
    jaw = smooth_step(v, 0.742, 0.722) * smooth_step(v, 0.650, 0.685) * smooth_step(side, 0.122, 0.085)
    cheek_line = smooth_step(v - 0.75 * side, 0.700, 0.668)
    chin = smooth_step(v, 0.727, 0.706) * smooth_step(side, 0.055, 0.03)
    moustache = smooth_step(v, 0.7490, 0.7425) * smooth_step(side, 0.033, 0.021) * smooth_step(v, 0.716, 0.722)
    zone = 1 - (1 - jaw * np.maximum(cheek_line, chin)) * (1 - moustache)
    zone = cv2.GaussianBlur(zone, (0, 0), 5.0)
    zone *= 1 - 0.55 * mirrored_blobs((0.020, 0.7085), (0.007, 0.006))  # bare beside the soul patch
    zone *= 1 - 0.5 * blob((0.0, 0.740), (0.0022, 0.006))  # philtrum
    patchy = np.clip(0.55 + 0.09 * noise(rng, 0.012, 2), 0, 1)
    hairs = np.clip(0.80 + 0.42 * noise(rng, 0.0007), 0.2, 2.0)
    return zone * patchy * hairs


def brow_shadow() -> NDArray[np.float32]:
    """Where brows grow, the skin is darker: the shade of hairs too fine to draw, [0, 1]."""
    total = np.zeros(CHART_SHAPE, np.float32)
    distance, place, (rows, columns) = curve_coordinates(BROW_LINE, 0.008)
    half = np.interp(place, [0, 0.1, 0.4, 0.7, 1], [0.0022, 0.0036, 0.0036, 0.0028, 0.0010])
    total[rows, columns] = (
        np.exp(-0.5 * (distance / half) ** 2) * smooth_step(place, -0.02, 0.10) * smooth_step(place, 1.0, 0.86)
    )
    return total + total[:, ::-1]


def _pores(rng: np.random.Generator) -> NDArray[np.float32]:
    """Relief of the pores, unit strength: coarse on nose and cheeks, fine elsewhere."""
    coarse = 0.35 + blob((0.0, 0.757), (0.013, 0.014)) + 0.8 * mirrored_blobs((0.026, 0.757), (0.014, 0.012))
    return noise(rng, 0.0008) * np.minimum(coarse, 1.3) + 0.5 * noise(rng, 0.0004)


def _lip_lines(rng: np.random.Generator) -> NDArray[np.float32]:
    """The lips' vertical lines, metres: noise stretched along v."""
    lines = cv2.GaussianBlur(noise(rng, 0.0012, 2), (0, 0), sigmaX=0.5, sigmaY=6)
    return (5e-5 * lines / lines.std()).astype(np.float32)


def _roughness(rng: np.random.Generator, lips: NDArray[np.float32], beard: NDArray[np.float32]) -> NDArray[np.float32]:
    """GGX roughness: oily on forehead and nose, matt on cheeks, moist on the lips and along the lids."""
    oil = (
        0.10 * blob((0.0, 0.835), (0.035, 0.018))
        + 0.14 * blob((0.0, 0.762), (0.009, 0.018))
        + 0.05 * blob((0.0, 0.695), (0.012, 0.008))
    )
    skin = 0.56 - oil + 0.035 * noise(rng, 0.004, 3) + 0.03 * beard
    return np.clip(skin * (1 - lips) + lips * (0.40 + 0.03 * noise(rng, 0.002)), 0.2, 0.8)
