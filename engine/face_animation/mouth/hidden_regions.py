"""The inside of the mouth, which the target does not show, from the driver (section 5)."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.filling.poisson import membrane
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.landmarks import FACE_OVAL, LIPS_INNER, LIPS_OUTER

LIP_EROSION_SHARE = 0.1
"""Section 5: the disk that erodes the mask of the lips has this share of the mouth's height as radius."""
APPEARING_AREA = 1.0
"""Section 5: multiples of the neutral mouth's own inner area at which the inside begins to appear."""
FULL_AREA = 2.0
"""Section 5: multiples of that area at which the inside is wholly there."""
APPEARING_GAP = 1.3
"""Multiples of the neutral gap between the lips at which the inside begins to appear as well (ours): a smile that becomes
an O hardly grows in area."""
FULL_GAP = 1.7
"""Multiples of that gap at which the inside is wholly there (ours)."""
MIN_INNER_AREA = 0.012
"""Floor of the neutral inner area, in squares of the mouth's width: a closed mouth has almost none."""
MIN_GAP = 0.04
"""Floor of the neutral gap between the lips, in widths of the mouth: a closed mouth has almost none."""
MOUTH_MIDDLE_PAIRS = ((82, 87), (13, 14), (312, 317))
"""Facing vertices of the inner lips, where they part most."""

TEETH_SATURATION = 0.2
"""Saturation of teeth, at most."""
LIP_SATURATION = 0.45
"""Saturation of lips, at least."""

LUMINANCE_WEIGHTS = np.array([0.299, 0.587, 0.114], np.float32)

UPPER_INNER_LIP = (78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308)
LOWER_INNER_LIP = (78, 95, 88, 178, 87, 14, 317, 402, 318, 324, 308)
"""Facing vertices of the inner lips from corner to corner."""


@dataclass(frozen=True)
class MouthPalette:
    """How the driver's colours become the target's.

    gain : (3,) float32, for the light.
    tint : (3,) float32, of the target's skin at luminance 1.
    chroma : how far the target's palette departs from that tint; 0 in black and white.
    brightest : luminance that the target's face shows, which teeth do not exceed by much.
    area : the neutral mouth's inner area, px^2.
    gap : between its lips, px.
    height : of both lips, px.
    """

    gain: NDArray[np.float32]
    tint: NDArray[np.float32]
    chroma: float
    brightest: float
    area: float
    gap: float
    height: float


def mouth_triangles() -> NDArray[np.int32]:
    """Triangles over the 40 lip vertices, outer contour first: the lips' ring and a strip across the opening."""
    outer, inner = np.arange(20), np.arange(20, 40)
    ring = []
    for k in range(20):
        n = (k + 1) % 20
        ring += [(outer[k], outer[n], inner[k]), (outer[n], inner[n], inner[k])]
    place = {v: 20 + i for i, v in enumerate(LIPS_INNER)}
    strip = []
    for k in range(len(UPPER_INNER_LIP) - 1):
        a, b, c, d = (
            place[v] for v in (UPPER_INNER_LIP[k], UPPER_INNER_LIP[k + 1], LOWER_INNER_LIP[k], LOWER_INNER_LIP[k + 1])
        )
        strip += [(a, b, c), (b, d, c)]
    return np.array(ring + strip, np.int32)


def match_palette(
    target: NDArray[np.uint8], mesh: NDArray[np.floating], crop: NDArray[np.uint8], crop_mesh: NDArray[np.floating]
) -> MouthPalette:
    """Compare the two faces: light by the skin of the cheeks, palette by how much the lips differ from it.

    Parameters
    ----------
    target : (H, W, 3) with `mesh` (478, 2 or 3); crop : the driver's neutral frame with `crop_mesh` (478, 2).
    """
    a, b = _skin(target, mesh), _skin(crop, crop_mesh)
    gain = _light((a.mean(axis=0) + 4) / (b.mean(axis=0) + 4))
    tint = a.mean(axis=0) / max(float(a.mean(axis=0) @ LUMINANCE_WEIGHTS), 1.0)
    own = _departure(_lips(target, mesh), tint)
    chroma = float(np.clip(own / max(_departure(_lips(crop, crop_mesh) * gain, tint), 1e-3), 0, 1))
    inner = mesh[list(LIPS_INNER), :2].astype(np.float32)
    outer = mesh[list(LIPS_OUTER), :2].astype(np.float32)
    width = float(np.linalg.norm(mesh[61, :2] - mesh[291, :2]))
    area = max(float(cv2.contourArea(inner)), MIN_INNER_AREA * width**2)
    return MouthPalette(
        gain.astype(np.float32),
        tint.astype(np.float32),
        chroma,
        _brightest(target, mesh),
        area,
        max(_gap(mesh), MIN_GAP * width),
        float(np.ptp(outer[:, 1])),
    )


def _gap(mesh: NDArray[np.floating]) -> float:
    """Pixels between the lips, in the middle."""
    top, bottom = np.array(MOUTH_MIDDLE_PAIRS).T
    return float(np.linalg.norm(mesh[top, :2] - mesh[bottom, :2], axis=1).mean())


def _light(ratio: NDArray[np.float32]) -> NDArray[np.float32]:
    """What of the ratio (3,) of two skins is light: all of its brightness, half of its colour (the other half
    is that people differ), and none of it green, which skins are and light in pictures of people is not."""
    brightness = float(ratio @ LUMINANCE_WEIGHTS)
    colour = np.sqrt(ratio / brightness)
    colour[1] = min(colour[1], max(colour[0], colour[2]))
    return np.asarray(brightness * colour / float(colour @ LUMINANCE_WEIGHTS), np.float32)


def unseen_mouth_share(mesh: NDArray[np.floating], palette: MouthPalette) -> float:
    """How much of what is seen in the mouth of a frame's face (478, 2) the target does not show, from 0 to 1."""
    inner = mesh[list(LIPS_INNER), :2].astype(np.float32)
    grown = (float(cv2.contourArea(inner)) / palette.area - APPEARING_AREA) / (FULL_AREA - APPEARING_AREA)
    return float(np.clip(max(grown, (_gap(mesh) / palette.gap - APPEARING_GAP) / (FULL_GAP - APPEARING_GAP)), 0, 1))


def transfer_mouth(
    frame: NDArray[np.uint8],
    mesh: NDArray[np.floating],
    crop: NDArray[np.uint8],
    crop_mesh: NDArray[np.floating],
    palette: MouthPalette,
) -> None:
    """Put the driver's mouth interior into a frame of the target, in place.

    Parameters
    ----------
    frame : (H, W, 3) the warped target, with its face at `mesh` (478, 2).
    crop : the driver's frame, with its face at `crop_mesh` (478, 2).
    """
    blend = unseen_mouth_share(mesh, palette)
    if blend == 0:
        return
    inner = mesh[list(LIPS_INNER), :2].astype(np.float32)
    outer = mesh[list(LIPS_OUTER), :2].astype(np.float32)
    box = box_around(outer, frame.shape[:2])
    if box is None:
        return
    x0, y0, x1, y1 = box
    corner = np.array([x0, y0], np.float32)
    lips = np.concatenate([outer, inner]) - corner
    source = crop_mesh[list(LIPS_OUTER + LIPS_INNER)].astype(np.float32)
    origin = inverse_map(lips, source, mouth_triangles(), (y1 - y0, x1 - x0), outside=-1.0)
    aligned = cv2.remap(crop, origin[..., 0], origin[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    mouth = relight(np.asarray(aligned, np.uint8), palette)
    below = frame[y0:y1, x0:x1]
    mask = _eroded(outer - corner, (y1 - y0, x1 - x0), LIP_EROSION_SHARE * palette.height)
    opening = soft_polygon(inner - corner, (y1 - y0, x1 - x0))
    healed = membrane(below - mouth, mask) if mask.sum() > 9 else np.zeros_like(mouth)
    _blend(below, mouth, healed, np.asarray(aligned, np.uint8), np.float32(blend) * opening * mask)


@njit(fastmath=True, nogil=True)
def _blend(below, mouth, healed, driver, alpha):  # type: ignore[no-untyped-def]
    """The mouth over what is `below`, in place. Of what heals its edge the brightness counts everywhere, the colour where a
    pixel of the `driver` is lip, gum or tongue rather than tooth. What the lips of two people differ by in colour is true
    of lips, and would make teeth green."""
    height, width = alpha.shape
    for y in range(height):
        for x in range(width):
            a = alpha[y, x]
            if a == 0:
                continue
            most = max(driver[y, x, 0], driver[y, x, 1], driver[y, x, 2])
            least = min(driver[y, x, 0], driver[y, x, 1], driver[y, x, 2])
            saturation = np.float32(1) - np.float32(least) / np.float32(max(most, 16))
            t = min(
                max(
                    (saturation - np.float32(TEETH_SATURATION)) / np.float32(LIP_SATURATION - TEETH_SATURATION),
                    np.float32(0),
                ),
                np.float32(1),
            )
            red = t * t * (np.float32(3) - 2 * t)
            light = (
                healed[y, x, 0] * LUMINANCE_WEIGHTS[0]
                + healed[y, x, 1] * LUMINANCE_WEIGHTS[1]
                + healed[y, x, 2] * LUMINANCE_WEIGHTS[2]
            )
            for k in range(3):
                b = np.float32(below[y, x, k])
                value = mouth[y, x, k] + light + red * (healed[y, x, k] - light)
                below[y, x, k] = np.uint8(
                    min(max(b + a * (value - b) + np.float32(0.5), np.float32(0)), np.float32(255))
                )


def relight(rgb: NDArray[np.uint8], palette: MouthPalette) -> NDArray[np.float32]:
    """The driver's colours in the target's light and palette, float32."""
    lit = rgb.astype(np.float32) * palette.gain
    tinted = (lit @ LUMINANCE_WEIGHTS)[..., None] * palette.tint
    mouth = tinted + palette.chroma * (lit - tinted)
    light = np.maximum(mouth @ LUMINANCE_WEIGHTS, 1.0)
    knee = 1.1 * palette.brightest
    over = np.maximum(light - knee, 0)
    room = 0.3 * palette.brightest
    held = np.where(over > 0, knee + room * np.tanh(over / room), light)
    return np.asarray(mouth * (held / light)[..., None], np.float32)


def _skin(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
    """Colours (P, 3) of the cheeks beside the mouth, where neither beard nor lips are likely."""
    mask = np.zeros(rgb.shape[:2], np.uint8)
    for cheek in ((116, 117, 118, 100, 126, 203, 206, 205, 50), (345, 346, 347, 329, 355, 423, 426, 425, 280)):
        cv2.fillConvexPoly(mask, cv2.convexHull(mesh[list(cheek), :2].round().astype(np.int32)), 1)
    return rgb[mask > 0].astype(np.float32) if mask.any() else rgb.reshape(-1, 3).astype(np.float32)


def _brightest(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> float:
    """The 99th percentile of the luminance within the face's contour."""
    mask = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillPoly(mask, [mesh[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
    light = rgb[mask > 0].astype(np.float32) @ LUMINANCE_WEIGHTS
    return float(np.quantile(light, 0.99)) if len(light) else 255.0


def _lips(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
    mask = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillPoly(mask, [mesh[list(LIPS_OUTER), :2].round().astype(np.int32)], 1)
    cv2.fillPoly(mask, [mesh[list(LIPS_INNER), :2].round().astype(np.int32)], 0)
    return rgb[mask > 0].astype(np.float32) if mask.any() else _skin(rgb, mesh)


def _departure(colours: NDArray[np.float32], tint: NDArray[np.float32]) -> float:
    """Mean distance of the colours (P, 3), at luminance 1, from a tint."""
    light = np.maximum(colours @ LUMINANCE_WEIGHTS, 8.0)[:, None]
    return float(np.linalg.norm((colours / light).mean(axis=0) - tint))


def box_around(points: NDArray[np.float32], shape: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """x0, y0, x1, y1 around points (P, 2) within a picture of `shape`; None where hardly any of it is left."""
    low, high = np.floor(points.min(axis=0)).astype(int) - 2, np.ceil(points.max(axis=0)).astype(int) + 3
    x0, y0 = np.maximum(low, 0)
    x1, y1 = min(int(high[0]), shape[1]), min(int(high[1]), shape[0])
    return (int(x0), int(y0), x1, y1) if x1 - x0 > 4 and y1 - y0 > 4 else None


def soft_polygon(points: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """Coverage [0, 1] of a polygon, anti-aliased."""
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(points * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    return mask.astype(np.float32) / np.float32(255)


def _eroded(points: NDArray[np.float32], shape: tuple[int, int], radius: float) -> NDArray[np.bool_]:
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(points).astype(np.int32)], 1)
    mask[[0, -1]] = 0
    mask[:, [0, -1]] = 0
    size = 2 * max(1, round(radius)) + 1
    return np.asarray(cv2.erode(mask, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))) > 0)
