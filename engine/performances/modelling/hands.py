"""The template's hands, painted: nails, knuckles, creases, redder palms. Places are the template's own at rest, metres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.hands import bending_axes, finger_landmarks
from engine.body.rig import Rig
from engine.geometry.rigging.joint_names import FINGER_NAMES, Side
from engine.media.colour_conversion.tone_mapping import srgb_code
from engine.perception.pose.hands import HAND_JOINTS
from engine.performances.modelling.skin import BASE_REFLECTANCE, BLOOD_ABSORBANCE, MELANIN_ABSORBANCE

BACK_BLOOD, BACK_MELANIN = 0.30, 0.30
"""Pigments of the hand's back, in the units of `engine.performances.modelling.skin`."""
NAIL_LENGTH, NAIL_WIDTH_SHARE = 0.52, 0.72
"""Of a fingertip's last phalanx: how much of its length, and of its width, the nail takes."""
CREASE_WIDTH_METRES = 0.0009
"""Metres: standard deviation across a crease at a joint."""

FINGER_ROOT_PIGMENT = 0.2
"""By how much both pigments seem more at the roots of fingers, on their sides."""


@dataclass(frozen=True)
class Phalanx:
    """One bone of a finger: it runs from `start` to `end` (3,), and the finger's back looks along `back` (3,) there."""

    finger: str
    number: int
    start: NDArray[np.float64]
    end: NDArray[np.float64]
    back: NDArray[np.float64]


@dataclass(frozen=True)
class HandBones:
    """A hand of the template at rest: its `phalanges`; `wrist` (3,), `along` (3,) the unit vector from it to the knuckles, and
    `back` (3,) the one out of the back of the hand."""

    phalanges: tuple[Phalanx, ...]
    wrist: NDArray[np.float64]
    along: NDArray[np.float64]
    back: NDArray[np.float64]


def hand_bones(
    rig: Rig, rest: NDArray[np.floating], side: Side, heads: NDArray[np.floating] | None = None
) -> HandBones:
    """Where the bones of a hand lie in the template's `rest` vertices (V, 3), or begin at the joints `heads` (B, 3) of who has been brought into
    T-pose, where not all vertices that say where joints are have gone with them."""
    told, tails = rig.joints(rest)
    heads = told if heads is None else heads
    places = np.stack(
        [
            tails[rig.index(f"{side}Hand{name[:-1]}3")] if name.endswith("4") else heads[rig.index(f"{side}Hand{name}")]
            for name in HAND_JOINTS
        ]
    ).astype(np.float64)
    bend, _ = bending_axes(places)
    phalanges = []
    for number, finger in enumerate(FINGER_NAMES):
        chain = finger_landmarks(finger)
        for k in range(3):
            start, end = places[chain[k]], places[chain[k + 1]]
            back = np.cross(end - start, bend[number])  # a finger bends about its axis towards the palm
            phalanges.append(Phalanx(finger, k + 1, start, end, back / np.linalg.norm(back)))
    index, little = places[finger_landmarks("Index")[0]], places[finger_landmarks("Pinky")[0]]
    along = (index + little) / 2 - places[0]
    out = np.mean([each.back for each in phalanges if each.number == 1 and each.finger != "Thumb"], 0)
    out -= along * (out @ along) / (along @ along)
    return HandBones(tuple(phalanges), places[0], along / np.linalg.norm(along), out / np.linalg.norm(out))


def painted_hand(
    bones: HandBones, places: NDArray[np.floating], normals: NDArray[np.floating], seed: int = 17
) -> NDArray[np.float32]:
    """(N, 3) sRGB, 0 to 255, of a hand's skin at `places` (N, 3) with unit `normals` (N, 3)."""
    facing = normals @ bones.back
    grain = _noise(places, 0.0012, seed) + 0.7 * _noise(places, 0.006, seed + 1)
    palm = _ramp(-facing, -0.1, 0.5)
    blood = BACK_BLOOD + 0.04 * grain + 0.28 * palm
    melanin = BACK_MELANIN + 0.03 * _noise(places, 0.003, seed + 2) - 0.16 * palm
    nearest, along, across = _beside_bones(bones, places)
    nail = np.zeros(len(places))
    rim = np.zeros(len(places))
    tip = np.zeros(len(places))
    for number, bone in enumerate(bones.phalanges):
        own = np.flatnonzero(nearest == number)
        length = np.linalg.norm(bone.end - bone.start)
        towards = normals[own] @ bone.back
        from_joint = along[own] * length
        crease = np.exp(-0.5 * (from_joint / CREASE_WIDTH_METRES) ** 2)
        for shift, depth in ((-0.0028, 0.5), (0.0026, 0.5), (-0.0052, 0.25)) if bone.number == 2 else ():
            folds = np.exp(-0.5 * ((from_joint - shift) / CREASE_WIDTH_METRES) ** 2)
            crease = np.maximum(crease, depth * folds * (towards > 0))
        melanin[own] += 0.14 * crease * (0.5 + 0.5 * np.abs(towards))
        knuckle = np.exp(-0.5 * (from_joint / 0.006) ** 2) * _ramp(towards, 0.1, 0.7)
        blood[own] += 0.22 * knuckle
        # between fingers less light comes in
        hollow = _ramp(1 - np.abs(towards), 0.4, 1.0) * _ramp(1.6 - along[own] - bone.number, 0.0, 1.6)
        melanin[own] += FINGER_ROOT_PIGMENT * hollow
        blood[own] += FINGER_ROOT_PIGMENT * hollow
        if bone.number == 3:
            width = max(float(np.quantile(np.abs(across[own]), 0.98)), 1e-6) if len(own) else 1e-6
            inside = _nail(along[own], across[own] / width, towards)
            nail[own], rim[own] = inside
            tip[own] = _ramp(along[own], 0.9, 1.02)
            blood[own] += 0.14 * _ramp(along[own], 0.5, 1.0) * (1 - nail[own])
    blood, melanin = np.maximum(blood, 0.02), np.maximum(melanin, 0.02)
    skin = BASE_REFLECTANCE * np.exp(-blood[:, None] * BLOOD_ABSORBANCE - melanin[:, None] * MELANIN_ABSORBANCE)
    bed = BASE_REFLECTANCE * np.exp(-0.34 * BLOOD_ABSORBANCE - 0.06 * MELANIN_ABSORBANCE)
    free_edge = np.array([0.69, 0.48, 0.40])
    shell = bed + tip[:, None] * (free_edge - bed)
    albedo = (skin + nail[:, None] * (shell - skin)) * (1 - 0.15 * rim)[:, None]
    return np.asarray(255 * srgb_code(np.clip(albedo, 0, 1)), np.float32)


def past_wrist(bones: HandBones, places: NDArray[np.floating], length: float) -> NDArray[np.float64]:
    """(N,) how far places (N, 3) are past the wrist: 0 to 1 over `length` metres along the hand, smoothly."""
    return _ramp((places - bones.wrist) @ bones.along, 0.0, length)


def _beside_bones(
    bones: HandBones, places: NDArray[np.floating]
) -> tuple[NDArray[np.intp], NDArray[np.float64], NDArray[np.float64]]:
    """Of each place (N, 3) the number of the nearest phalanx, how far along it, and metres across, to either side. How
    far along is a part of its length, and may be below 0."""
    count = len(places)
    best = np.full(count, np.inf)
    nearest = np.zeros(count, np.intp)
    along, across = np.zeros(count), np.zeros(count)
    for number, bone in enumerate(bones.phalanges):
        axis = bone.end - bone.start
        length = np.linalg.norm(axis)
        side = np.cross(axis / length, bone.back)
        offset = places - bone.start
        share = offset @ axis / length**2
        lowest = -0.35 if bone.number == 1 else 0.0
        away = np.linalg.norm(offset - np.clip(share, lowest, 1.0)[:, None] * axis, axis=1)
        won = away < best
        best[won], nearest[won] = away[won], number
        along[won], across[won] = share[won], (offset @ side)[won]
    return nearest, along, across


def _nail(
    along: NDArray[np.float64], across: NDArray[np.float64], towards: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where a nail is, and its rim, (n,) each in [0, 1]: rounded at its root, on the finger's back; `across` in half widths."""
    root = 1.0 - NAIL_LENGTH
    to_root = np.clip((along - root) / 0.22, 0, 1)
    half = NAIL_WIDTH_SHARE * np.sqrt(np.maximum(1 - (1 - to_root) ** 2, 0))
    inside = half - np.abs(across)
    on = _ramp(inside, -0.03, 0.03) * _ramp(towards, 0.1, 0.25) * (along > root)
    rim = np.exp(-0.5 * (inside / 0.08) ** 2) * _ramp(towards, -0.05, 0.2) * (along > root - 0.05) * (along < 0.97)
    return on, rim


def _noise(places: NDArray[np.floating], size: float, seed: int) -> NDArray[np.float64]:
    """(N,) smooth variation in space of mean 0 and deviation 1, of features of about `size` metres."""
    random = np.random.default_rng(seed)
    waves = random.normal(0, 1, (20, 3))
    waves *= random.uniform(0.6, 1.4, (20, 1)) * 2 * np.pi / (2 * size) / np.linalg.norm(waves, axis=1, keepdims=True)
    sums = np.zeros(len(places))
    for wave, phase in zip(waves, random.uniform(0, 2 * np.pi, 20), strict=True):
        sums += np.sin(places @ wave + phase)
    return sums / np.sqrt(10)


def _ramp(value: NDArray[np.floating], low: float, high: float) -> NDArray[np.float64]:
    t = np.clip((np.asarray(value, np.float64) - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)
