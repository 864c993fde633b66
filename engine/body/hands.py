"""Where the 21 hand landmarks lie on each of the template's hands, and how its fingers bend."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.body_space import BodySpace
from engine.body.rig import Rig
from engine.body.template import Template
from engine.geometry.rigging.joint_names import FINGER_NAMES, Side
from engine.perception.pose.hands import HAND_JOINTS

FINGERTIP_DEPTH_METRES = 0.006
"""Metres within the skin at which the landmark of a fingertip lies."""


@dataclass(frozen=True)
class HandModel:
    """A hand's landmarks at rest, linear in the body's coefficients, as `engine.perception.pose.hands.HAND_JOINTS` orders them.

    side : the person's.
    joints : (21,) int, the joint of the space that carries each.
    mean : (21, 3) float32 metres, where they are in the mean body's T-pose.
    basis : (K, 21, 3) float32 metres, what one unit of each coefficient adds.
    bend : (5, 3) float32 unit vectors of the T-pose, about which each finger's joints bend towards the palm.
    spread : (3,) float32 unit vector of the T-pose, about which fingers turn from the thumb's side to the other.
    """

    side: Side
    joints: NDArray[np.intp]
    mean: NDArray[np.float32]
    basis: NDArray[np.float32]
    bend: NDArray[np.float32]
    spread: NDArray[np.float32]


def hand_model(template: Template, space: BodySpace, rig: Rig, side: Side) -> HandModel:
    """The model of one hand. `rig` has the joints of `space`."""
    body = template.vertices_of("body")
    strongest = rig.bones[body, 0]
    joints, means, bases = [], [], []
    for name in HAND_JOINTS:
        tip = name.endswith("4")
        at = space.names.index(f"{side}Hand{name[:-1]}3" if tip else f"{side}Hand{name}")
        joints.append(at)
        if not tip:
            means.append(space.joint_mean[at])
            bases.append(space.joint_basis[:, at])
            continue
        own = body[strongest == at]
        along = space.mean[own].mean(0) - space.joint_mean[at]
        along = along / np.linalg.norm(along)
        last = own[np.argmax(space.mean[own] @ along)]
        means.append(space.mean[last] - FINGERTIP_DEPTH_METRES * along)
        bases.append(space.basis[:, last])
    places = np.stack(means)
    bend, spread = bending_axes(places)
    return HandModel(
        side,
        np.array(joints, np.intp),
        places.astype(np.float32),
        np.stack(bases, 1).astype(np.float32),
        bend.astype(np.float32),
        spread.astype(np.float32),
    )


def finger_landmarks(finger: str) -> list[int]:
    """The landmarks of a finger from its first joint to its tip."""
    return [HAND_JOINTS.index(f"{finger}{k}") for k in (1, 2, 3, 4)]


def bending_axes(places: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Axes of bending (5, 3) and of spreading (3,) for the landmarks (21, 3) of a hand at rest.

    Fingers bend in the plane of their own direction and the palm's; the thumb bends to where the little finger begins.
    """
    index, little = places[finger_landmarks("Index")[0]], places[finger_landmarks("Pinky")[0]]
    across = index - little
    along = (index + little) / 2 - places[0]
    palm = np.cross(along, across)
    tips = places[[finger_landmarks(finger)[3] for finger in FINGER_NAMES[1:]]].mean(0) - (index + little) / 2
    palm *= np.sign(palm @ tips)  # fingers at rest are a little bent, towards the palm
    palm /= np.linalg.norm(palm)
    axes = []
    for finger in FINGER_NAMES:
        first, last = finger_landmarks(finger)[1 if finger == "Thumb" else 0], finger_landmarks(finger)[3]
        out = places[last] - places[first]
        axes.append(np.cross(out, little - places[first] if finger == "Thumb" else palm))
    bend = np.stack(axes)
    return bend / np.linalg.norm(bend, axis=1, keepdims=True), palm
