"""Phone video in high dynamic range (HLG, PQ) and wide gamut, brought to sRGB.

Light as the display would give it (ITU-R BT.2100) is set against the white of ordinary video at 203 cd/m2 (BT.2408).
Highlights are rolled off by the curve of BT.2390 (section 5.4.1): all below a knee at about 90 cd/m2, faces among it, keeps
its light exactly. Colours outside sRGB move towards grey of the same luminance.

Per pixel: code values to light (a table), a gain that depends on the luminance alone (a table), a matrix, and sRGB's
curve (a table).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from engine.compiled import njit

Transfer = Literal["hlg", "pq", "sdr"]
Primaries = Literal["bt2020", "p3", "bt709"]

WHITE_NITS = 203.0
"""Luminance of diffuse white, cd/m2 (BT.2408)."""

PEAK_NITS = 1000.0
"""Luminance of the display that the picture was made for, cd/m2: BT.2100's reference for HLG, usual for PQ; more is
clipped."""

_CHROMATICITIES: dict[str, tuple[tuple[float, float], ...]] = {
    "bt709": ((0.640, 0.330), (0.300, 0.600), (0.150, 0.060)),
    "bt2020": ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046)),
    "p3": ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060)),  # SMPTE EG 432-1
}
_WHITE_POINT_D65 = (0.3127, 0.3290)
_TABLE_STEPS = 16384  # of the tables over luminance and light, which are read at the fourth and square root


@dataclass(frozen=True)
class ToneMap:
    """One conversion to sRGB.

    light : float32 (65536,) by code value.
    luminance : float32 (3,) weights.
    gain : float32 by the luminance's fourth root.
    matrix : float32 (3, 3) to linear BT.709, white at 1.
    code : uint8, sRGB by the light's square root.
    """

    light: np.ndarray
    luminance: np.ndarray
    gain: np.ndarray
    matrix: np.ndarray
    code: np.ndarray

    def apply(self, codes: np.ndarray) -> np.ndarray:
        """Code values uint16 (H, W, 3) over 0..65535 to sRGB uint8 (H, W, 3)."""
        srgb = np.empty(codes.shape, np.uint8)
        grey = xyz_of("bt709")[1].astype(np.float32)
        flat = np.ascontiguousarray(codes).reshape(-1, 3)
        _apply(flat, self.light, self.luminance, self.gain, self.matrix, grey, self.code, srgb.reshape(-1, 3))
        return srgb


def tone_map(transfer: Transfer, primaries: Primaries) -> ToneMap:
    """The conversion for pictures of this transfer and these primaries."""
    code = np.linspace(0, 1, 65536)
    luminance = np.linspace(0, 1, _TABLE_STEPS + 1) ** 4
    to_xyz = xyz_of(primaries)
    if transfer == "hlg":
        light = hlg_scene_light(code)
        # BT.2100's OOTF: the display gives PEAK * Y^0.2 times the scene's light, so PEAK * Y^1.2 in luminance.
        shown = PEAK_NITS * luminance**1.2
        gain = roll_off(shown) / WHITE_NITS / np.maximum(luminance, luminance[1])
    elif transfer == "pq":
        light = np.minimum(pq_light(code) / PEAK_NITS, 1)
        gain = roll_off(PEAK_NITS * luminance) / WHITE_NITS / np.maximum(luminance, luminance[1])
    else:
        light, gain = srgb_light(code), np.ones(_TABLE_STEPS + 1)
    gain[0] = gain[1]
    matrix = np.linalg.inv(xyz_of("bt709")) @ to_xyz
    curve = np.round(255 * srgb_code(np.linspace(0, 1, _TABLE_STEPS + 1) ** 2)).astype(np.uint8)
    light, luminance_weights, gain, matrix = (a.astype(np.float32) for a in (light, to_xyz[1], gain, matrix))
    return ToneMap(light, luminance_weights, gain, matrix, curve)


def srgb_light(code: np.ndarray) -> np.ndarray:
    """Linear light of sRGB code values, both in [0, 1] (IEC 61966-2-1)."""
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def srgb_code(light: np.ndarray) -> np.ndarray:
    """sRGB code values of linear light, both in [0, 1]: the inverse of `srgb_light`."""
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * np.maximum(light, 0.0031308) ** (1 / 2.4) - 0.055)


_M1, _M2, _C1, _C2, _C3 = 2610 / 16384, 2523 / 32, 3424 / 4096, 2413 / 128, 2392 / 128


def pq_light(code: np.ndarray) -> np.ndarray:
    """cd/m2 of PQ code values in [0, 1] (BT.2100, table 4)."""
    power = np.maximum(code, 0) ** (1 / _M2)
    return 10000 * (np.maximum(power - _C1, 0) / (_C2 - _C3 * power)) ** (1 / _M1)


def pq_code(nits: np.ndarray) -> np.ndarray:
    """PQ code values of cd/m2: the inverse of `pq_light`."""
    power = (np.maximum(nits, 0) / 10000) ** _M1
    return ((_C1 + _C2 * power) / (1 + _C3 * power)) ** _M2


def hlg_scene_light(code: np.ndarray) -> np.ndarray:
    """Light of the scene in [0, 1] of HLG code values in [0, 1] (BT.2100, table 5, inverse OETF)."""
    a, b, c = 0.17883277, 0.28466892, 0.55991073
    return np.where(code <= 0.5, code**2 / 3, (np.exp((np.maximum(code, 0.5) - c) / a) + b) / 12)


def roll_off(nits: np.ndarray) -> np.ndarray:
    """cd/m2 for a display whose peak is `WHITE_NITS`, of cd/m2 for one whose peak is `PEAK_NITS` (BT.2390, section 5.4.1)."""
    peak = pq_code(np.array(PEAK_NITS))
    ceiling = float(pq_code(np.array(WHITE_NITS)) / peak)
    knee = 1.5 * ceiling - 0.5
    code = np.minimum(pq_code(nits) / peak, 1)
    t = np.clip((code - knee) / (1 - knee), 0, 1)
    bent = (2 * t**3 - 3 * t**2 + 1) * knee + (t**3 - 2 * t**2 + t) * (1 - knee) + (3 * t**2 - 2 * t**3) * ceiling
    return np.where(code < knee, nits, pq_light(bent * peak))


def xyz_of(primaries: Primaries) -> np.ndarray:
    """The (3, 3) matrix from linear RGB to CIE XYZ, white (D65) at luminance 1; its second row gives luminance."""
    columns = np.array([[x / y, 1, (1 - x - y) / y] for x, y in _CHROMATICITIES[primaries]]).T
    x, y = _WHITE_POINT_D65
    return columns * np.linalg.solve(columns, [x / y, 1, (1 - x - y) / y])


@njit(nogil=True, error_model="numpy")
def _apply(
    codes: np.ndarray,
    light: np.ndarray,
    luminance: np.ndarray,
    gain: np.ndarray,
    matrix: np.ndarray,
    grey_weights: np.ndarray,
    curve: np.ndarray,
    srgb: np.ndarray,
) -> None:
    zero, one, half, steps = np.float32(0), np.float32(1), np.float32(0.5), np.float32(len(curve) - 1)
    for i in range(codes.shape[0]):
        r, g, b = light[codes[i, 0]], light[codes[i, 1]], light[codes[i, 2]]
        total = luminance[0] * r + luminance[1] * g + luminance[2] * b
        factor = gain[int(np.sqrt(np.sqrt(total)) * steps + half)]
        r, g, b = (
            factor * (matrix[0, 0] * r + matrix[0, 1] * g + matrix[0, 2] * b),
            factor * (matrix[1, 0] * r + matrix[1, 1] * g + matrix[1, 2] * b),
            factor * (matrix[2, 0] * r + matrix[2, 1] * g + matrix[2, 2] * b),
        )
        low, high = min(r, g, b), max(r, g, b)
        if low < zero or high > one:
            grey = min(max(grey_weights[0] * r + grey_weights[1] * g + grey_weights[2] * b, zero), one)
            share = one
            if low < zero:
                share = grey / (grey - low)
            if high > one:
                share = min(share, (one - grey) / (high - grey))
            r, g, b = grey + share * (r - grey), grey + share * (g - grey), grey + share * (b - grey)
        srgb[i, 0] = curve[int(min(np.sqrt(max(r, zero)), one) * steps + half)]
        srgb[i, 1] = curve[int(min(np.sqrt(max(g, zero)), one) * steps + half)]
        srgb[i, 2] = curve[int(min(np.sqrt(max(b, zero)), one) * steps + half)]
