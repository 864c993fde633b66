"""What stands out in a picture, whoever or whatever it is: the small U2-Net, beside the networks that know people.

X. Qin and others, U2-Net: Going deeper with nested U-structure for salient object detection, Pattern Recognition 2020. It sees edges four
times as finely as the networks of people, and with them gaps between limbs; what people are it does not know, and takes a bench for
one. So it is asked about the surroundings of people alone, and has half a say.
"""

from __future__ import annotations

import hashlib
from functools import cache
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.imaging.masks.mask_pieces import bounding_box, pieces_by_area
from engine.imaging.resample import resized
from engine.package_data import IncompleteInstallation, package_data

Mask = NDArray[np.float32]

MODEL_FILE = "u2netp.onnx"
MODEL_SHA256 = "309c8469258dda742793dce0ebea8e6dd393174f89934733ecc8b14c76f4ddd8"

NETWORK_SIDE_PIXELS = 320
"""Pixels of the square that the network looks at."""
COLOUR_MEANS, COLOUR_DEVIATIONS = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)
"""Of the colours in [0, 1] that it was trained on."""
PEOPLE_MARGIN_SHARE = 0.2
"""How much of the picture around people it looks at, as a share of their box's longer side."""
MIN_PEOPLE_PIXELS = 16
"""Pixels of people from which there is somebody to look at."""
SALIENCE_SHARE = 0.5
"""Share of salience in the belief."""
EDGE_WIDTH, THING_HALF_WIDTH = 0.012, 0.015
"""How far beside people what stands out is no more than a finer edge, and half the width from which on it is a thing
beyond that, as shares of their height. What is thinner is a foot or a hand that the networks of people miss."""
HELD_BELIEF, HAND_REACH = 0.9, 0.075
"""Belief that a thing is somebody's that reaches one of their hands: so far from it at most, as a share of their height."""
LARGEST_HELD, HELD_THING_LIMITS = 0.3, 0.7
"""Size of what is held, as a share of people's, at most, and how surely all of it stands out, in the mean. What goes on beyond what is looked
at is held by nobody."""
NETWORK_THREADS = 2
"""Of the network."""


def with_salience(rgb: NDArray[np.uint8], people: Mask, limbs: NDArray[np.bool_], hands: NDArray[np.floating]) -> Mask:
    """The belief in people (h, w) in [0, 1] of a picture (H, W, 3), together with what stands out around them.

    limbs : (H, W), where joints say that somebody is: what stands out has no say there, as black trousers before black do not.
    hands : (K, 2) pixels of the picture. A thing that stands out beside people is theirs as a whole if it reaches a hand, else not at all.

    Raises `IncompleteInstallation` where set-up has not put the network there.
    """
    seen = people > 0.5
    if seen.sum() < MIN_PEOPLE_PIXELS:
        return people
    size = (people.shape[1], people.shape[0])
    small = resized(np.ascontiguousarray(rgb), size)
    rows, columns = bounding_box(seen)
    height = rows.stop - rows.start
    box = bounding_box(seen, round(PEOPLE_MARGIN_SHARE * max(height, columns.stop - columns.start)))
    salient = people.copy()
    part = np.ascontiguousarray(small[box])
    salient[box] = resized(salience(part), (part.shape[1], part.shape[0]))
    known = resized(limbs.astype(np.float32), size) > 0.5
    belief = (1 - SALIENCE_SHARE) * people + SALIENCE_SHARE * np.where(known, np.maximum(salient, people), salient)
    at = (np.asarray(hands, np.float64).reshape(-1, 2) + 0.5) * (np.array(size) / rgb.shape[1::-1]) - 0.5
    things = (salient > 0.5) & (distance_to(seen) > EDGE_WIDTH * height)
    reach = max(1, round(THING_HALF_WIDTH * height))
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    thick = cv2.morphologyEx(things.astype(np.uint8), cv2.MORPH_OPEN, disk) > 0
    for thing in pieces_by_area(things, MIN_PEOPLE_PIXELS):
        if not (thing & thick).any():
            continue
        y, x = np.nonzero(thing)
        away = np.linalg.norm(np.stack([x, y], 1)[:, None] - at, axis=-1).min(initial=np.inf)
        within = thing[box]
        whole = not (within[[0, -1]].any() or within[:, [0, -1]].any())
        whole = whole and salient[thing].mean() > HELD_THING_LIMITS and thing.sum() < LARGEST_HELD * seen.sum()
        around = dilate_mask(thing, max(1, round(EDGE_WIDTH * height))) & ~seen
        held = whole and away < HAND_REACH * height
        belief[around] = np.maximum(belief, HELD_BELIEF * salient)[around] if held else people[around]
    return np.clip(belief, 0, 1).astype(np.float32)


def salience(rgb: NDArray[np.uint8]) -> Mask:
    """What stands out (`NETWORK_SIDE_PIXELS`, `NETWORK_SIDE_PIXELS`) of a picture (H, W, 3) that is made a square of that size; in [0, 1]."""
    square = resized(np.ascontiguousarray(rgb), (NETWORK_SIDE_PIXELS, NETWORK_SIDE_PIXELS)).astype(
        np.float32
    ) / np.float32(255)
    normal = (square - np.array(COLOUR_MEANS, np.float32)) / np.array(COLOUR_DEVIATIONS, np.float32)
    session = loaded_network()
    tensor = np.ascontiguousarray(normal.transpose(2, 0, 1)[None], np.float32)
    return np.asarray(session.run(None, {session.get_inputs()[0].name: tensor})[0][0, 0], np.float32)


@cache
def loaded_network() -> Any:
    """The network itself, read once. Raises `IncompleteInstallation`."""
    import onnxruntime

    path = package_data("engine.perception", MODEL_FILE)
    content = path.read_bytes()
    if hashlib.sha256(content).hexdigest() != MODEL_SHA256:
        raise IncompleteInstallation(
            "installation_incomplete",
            f"{path} is not the file that it should be: remove it and run `make setup` again.",
        )
    options = onnxruntime.SessionOptions()
    options.log_severity_level = 3
    options.intra_op_num_threads = NETWORK_THREADS
    return onnxruntime.InferenceSession(content, options, providers=["CPUExecutionProvider"])
