"""The template's teeth, tongue and the bag behind its lips, painted. Places are the template's own at rest, metres."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.performances.modelling.teeth import LOWER_CROWNS, UPPER_CROWNS

ENAMEL_IN_MOUTH_RGB, DENTINE_IN_MOUTH_RGB, GUM_IN_MOUTH_RGB = (
    np.array([204, 195, 178.0]),
    np.array([182, 165, 134.0]),
    np.array([176, 96, 95.0]),
)
TONGUE_IN_MOUTH_RGB, TONGUE_ROOT = np.array([184, 104, 104.0]), np.array([104, 48, 50.0])
LINING_IN_MOUTH_RGB, THROAT_IN_MOUTH_RGB = np.array([142, 66, 66.0]), np.array([36, 12, 14.0])
"""Colours (sRGB) as they look in a mouth, which is dark: textures are shown without its shade."""
JAW_CROWN_SHARE = 0.62
"""Of a jaw's height from the edge of the teeth, how much is crowns; the rest is gum."""
GAP_WIDTH_METRES = 0.00022
"""Metres: half the dark gap between two teeth."""
LINING_DARKENING_METRES = 0.055
"""Metres behind the lips at which the mouth's lining has become as dark as the throat."""
MOUTH_LIGHT_REACH_METRES, MIN_MOUTH_LIGHT_SHARE = 0.018, 0.12
"""Metres behind the incisors, or the tongue's tip, over which the light that falls between open lips sinks to a third,
and the least of it."""


def mouth_light(places: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N, 3) which share of the light on the foremost of a part's `places` (N, 3) falls on each in a mouth that is open.
    Engines light it as if there were no lips before it. It is the redder the less it is: the least has come by way of the
    lining."""
    if not len(places):
        return np.zeros((0, 3), np.float32)
    behind = places[:, 2].max() - places[:, 2]
    share = MIN_MOUTH_LIGHT_SHARE + (1 - MIN_MOUTH_LIGHT_SHARE) * np.exp(-behind / MOUTH_LIGHT_REACH_METRES)
    reddening = np.log(LINING_IN_MOUTH_RGB / LINING_IN_MOUTH_RGB[0]) / np.log(MIN_MOUTH_LIGHT_SHARE)
    return np.asarray(share[:, None] ** (1 + reddening), np.float32)


def painted_teeth(places: NDArray[np.floating], upper: bool) -> NDArray[np.float32]:
    """(N, 3) sRGB, 0 to 255, of one jaw's row of teeth at `places` (N, 3)."""
    if not len(places):
        return np.zeros((0, 3), np.float32)
    low, high = places[:, 1].min(), places[:, 1].max()
    height = (places[:, 1] - low) / max(high - low, 1e-9)
    height = 1 - height if not upper else height  # 0 at the biting edge
    along = _along_the_arch(places)
    widths = 0.985e-3 * np.array([width for width, _ in (UPPER_CROWNS if upper else LOWER_CROWNS)])
    widths *= along.max() / widths.sum()
    borders = np.concatenate([[0], np.cumsum(widths)])
    tooth = np.clip(np.searchsorted(borders, along, side="right") - 1, 0, len(widths) - 1)
    phase = (along - borders[tooth]) / widths[tooth]
    to_gap = np.minimum(phase, 1 - phase) * widths[tooth]
    crown = JAW_CROWN_SHARE * (1 - 0.22 * (2 * phase - 1) ** 2)  # gums are scalloped about each tooth
    on_gum = _ramp(height, crown - 0.03, crown + 0.03)[:, None]
    body = _ramp(height, 0.0, 1.1 * JAW_CROWN_SHARE)[:, None]
    enamel = ENAMEL_IN_MOUTH_RGB + body * (DENTINE_IN_MOUTH_RGB - ENAMEL_IN_MOUTH_RGB)
    enamel = enamel * (1 - 0.35 * np.exp(-0.5 * (to_gap / GAP_WIDTH_METRES) ** 2))[:, None]
    return np.asarray(enamel + on_gum * (GUM_IN_MOUTH_RGB - enamel), np.float32)


def painted_tongue(places: NDArray[np.floating], seed: int = 11) -> NDArray[np.float32]:
    """(N, 3) sRGB of the tongue: grained by its papillae, furrowed in the middle, darker towards the root."""
    if not len(places):
        return np.zeros((0, 3), np.float32)
    depth = (places[:, 2].max() - places[:, 2]) / max(float(np.ptp(places[:, 2])), 1e-9)
    colour = TONGUE_IN_MOUTH_RGB + _ramp(depth, 0.25, 1.0)[:, None] * (TONGUE_ROOT - TONGUE_IN_MOUTH_RGB)
    random = np.random.default_rng(seed)
    waves = random.normal(0, 1, (24, 3))
    waves *= random.uniform(2500, 6000, (24, 1)) / np.linalg.norm(waves, axis=1, keepdims=True)
    grain = np.sin(places @ waves.T + random.uniform(0, 6.28, 24)).mean(1)
    furrow = 0.12 * np.exp(-0.5 * (places[:, 0] / 0.0012) ** 2) * (1 - depth)
    return np.asarray(colour * (1 + 0.25 * grain - furrow)[:, None], np.float32)


def painted_lining(places: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N, 3) sRGB of the inside of lips and cheeks, dark towards the throat."""
    if not len(places):
        return np.zeros((0, 3), np.float32)
    depth = places[:, 2].max() - places[:, 2]
    return np.asarray(
        LINING_IN_MOUTH_RGB
        + _ramp(depth, 0.1 * LINING_DARKENING_METRES, LINING_DARKENING_METRES)[:, None]
        * (THROAT_IN_MOUTH_RGB - LINING_IN_MOUTH_RGB),
        np.float32,
    )


def _along_the_arch(places: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) metres from the middle along the arch, of which the template has half an ellipse."""
    half = np.abs(places[:, 0]).max()
    depth = float(np.ptp(places[:, 2]))
    turn = np.arctan2(np.abs(places[:, 0]) / half, (places[:, 2] - places[:, 2].min()) / max(depth, 1e-9))
    steps = np.linspace(0, np.pi / 2, 200)
    arc = np.concatenate([[0], np.cumsum(np.hypot(np.diff(half * np.sin(steps)), np.diff(depth * np.cos(steps))))])
    return np.interp(turn, steps, arc)


def _ramp(
    value: NDArray[np.floating], low: NDArray[np.floating] | float, high: NDArray[np.floating] | float
) -> NDArray:
    t = np.clip((value - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))
