"""The person in the picture: who is found, where the joints are, and whether that is enough."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.placed_joints import REQUIRED_PLACED_JOINTS, check_places, check_skeleton, in_words
from engine.character.figure.posture import check_posture
from engine.errors import InputError
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.resample import resized, size_within
from engine.media.image import over_grey, read_image
from engine.media.limits import Limits
from engine.perception.face.faces import find_faces
from engine.perception.masks.figure import figure_on_paper
from engine.perception.pose.body import BODY_LANDMARKS, Body
from engine.perception.pose.hands import HAND_JOINTS, find_hands
from engine.perception.pose.outline_skeleton import outline_skeleton
from engine.perception.pose.people import covered_by, find_body_within, find_people, person_box

MAX_PICTURE_PIXELS = 1920
"""Pixels: larger pictures are made smaller first."""
SHOULDER_JOINTS = ("LeftShoulder", "RightShoulder")
"""Without them there is nothing to animate."""
HAND_LANDMARK_JOINTS = {"Wrist": "", "Index": "Index1", "Pinky": "Pinky1", "Thumb": "Thumb2"}
"""Landmarks of the body that are among the hand's, as joints: where a hand is seen closely, they are where it has them."""
LOWER_BODY_JOINTS = ("LeftHip", "RightHip", "LeftKnee", "RightKnee", "LeftAnkle", "RightAnkle")
"""What `partial` does without: where it is cut off or hidden, the network of body poses guesses it well."""
MIN_JOINT_CONFIDENCE = 0.35
"""Confidence below which a joint is not in the picture."""
BOX_MARGIN_SHARE = 0.1
"""By how much more than a box drawn by hand is looked at, as a share of its sides: it may be drawn too tightly."""
MIN_CROWD_PEOPLE = 10
"""People among whom the largest is not taken for the one who is meant."""
FACE_CROP_PIXELS = 320
"""Pixels to which a small head is enlarged where its face is looked for."""
MIN_PERSON_HEIGHT_PIXELS = 80
"""Pixels from the highest to the lowest joint; a smaller person has nothing to animate."""


@dataclass(frozen=True)
class Choice:
    """What a user says about who is meant, in pixels of the original picture.

    index : of those found, counted from the largest; None for the largest unless there is a crowd.
    box : (x, y, width, height) in which to look; beside it an index says nothing.
    placed : joints placed by hand: name, x, y.
    """

    box: tuple[float, float, float, float] | None = None
    index: int | None = None
    placed: tuple[tuple[str, float, float], ...] = ()


@dataclass(frozen=True)
class Figure:
    """One person of a picture, and where their joints are.

    rgb : (H, W, 3) the picture's colours, to be seen only as far as its own `alpha` shows them, if it has one.
    alpha : (H, W) float32 in [0, 1].
    points : (33, 2) pixels.
    confidence : (33,) of the points, as in `engine.perception.pose.body.Body`.
    world : (33, 3) as there; `spatial` says whether it is known.
    original : width and height of the picture as it was given, of which `rgb` may be a smaller copy.
    people : (N, 4) the boxes of all who were found, of whom this is number `index`.
    others : (H, W) bool, where the rest of them surely are.
    face : (478, 3) the mesh of the face, as `engine.perception.face.faces.find_faces` gives it; None where none is seen.
    hands : the left and the right, each (21, 3) as `engine.perception.pose.hands.Hand` has its points, with their depth; None where it is not seen.
    drawn : nobody whom networks see, but a figure on plain paper, whose joints are its outline's.
    placed : the joints that were placed by hand.
    """

    rgb: NDArray[np.uint8]
    alpha: NDArray[np.float32] | None
    points: NDArray[np.float32]
    confidence: NDArray[np.float32]
    world: NDArray[np.float32]
    spatial: bool
    original: tuple[int, int]
    people: NDArray[np.float32]
    index: int
    others: NDArray[np.bool_]
    face: NDArray[np.float32] | None
    hands: tuple[NDArray[np.float32] | None, NDArray[np.float32] | None]
    drawn: bool = False
    placed: tuple[str, ...] = ()

    @property
    def scale(self) -> NDArray[np.float64]:
        """Pixels of `rgb` for each of the original picture's, along x and y (2,): both sides are rounded to whole pixels."""
        return np.array(self.rgb.shape[1::-1]) / self.original

    def point(self, name: str) -> NDArray[np.float32]:
        """The pixel (2,) of one of the landmarks."""
        return self.points[BODY_LANDMARKS.index(name)]


def find_figure(path: Path, choice: Choice, partial: bool, limits: Limits, warn: Callable[[str, str], None]) -> Figure:
    """Find the person in a picture.

    Raises
    ------
    InputError : `no_person`, `not_full_body`, `person_too_small`, `person_lying`, `crowd`, `person_index_out_of_range`,
    `person_box_outside`, `unknown_joint`, `joint_outside`, `joints_invalid`, and what reading a picture may raise.
    """
    picture = read_image(path, limits)
    height, width = picture.rgb.shape[:2]
    joints = {name: (x, y) for name, x, y in choice.placed}
    check_places(joints, (height, width))
    size = size_within(picture.rgb.shape, MAX_PICTURE_PIXELS)
    scale = np.array(size) / (width, height)
    rgb = np.ascontiguousarray(resized(picture.rgb, size))
    alpha = None if picture.alpha is None else np.clip(resized(picture.alpha, size), 0, 1)
    shown = np.ascontiguousarray(over_grey(rgb, alpha))
    people = find_people(shown)
    body, index = _chosen(shown, people, choice, scale)
    if body is not None and index == len(people):  # found in a box alone
        people = [*people, body]
    sketched = None if body is not None else _sketched(shown, choice, scale)
    if body is None and sketched is None and not set(REQUIRED_PLACED_JOINTS) <= set(joints):
        raise InputError(
            "no_person",
            "No person was found in the picture: choose one that shows somebody whole, or place the joints by hand "
            f"({in_words(REQUIRED_PLACED_JOINTS)}).",
            ("joints", "person_box"),
        )
    points = np.zeros((len(BODY_LANDMARKS), 2), np.float32) if body is None else body.points.copy()
    confidence = np.zeros(len(BODY_LANDMARKS), np.float32) if body is None else body.confidence.copy()
    if sketched is not None:
        points, confidence = sketched.copy(), np.ones(len(BODY_LANDMARKS), np.float32)
        warn(
            "figure_drawn",
            "The figure was found by its outline, as a drawing: it moves as a flat cut-out. If a joint is elsewhere, move it.",
        )
    for name, place in joints.items():
        points[BODY_LANDMARKS.index(name)] = (np.array(place) + 0.5) * scale - 0.5
        confidence[BODY_LANDMARKS.index(name)] = 1
    if joints:
        check_skeleton(points, warn)
    hands = (None, None) if body is None else _hands(shown, replace(body, points=points))
    for side, hand in zip(SIDE_NAMES, hands, strict=True):
        for mark, joint in HAND_LANDMARK_JOINTS.items():
            if hand is not None and f"{side}{mark}" not in joints:
                points[BODY_LANDMARKS.index(f"{side}{mark}")] = hand[HAND_JOINTS.index(joint), :2]
                confidence[BODY_LANDMARKS.index(f"{side}{mark}")] = 1
    figure = Figure(
        rgb=rgb,
        alpha=alpha,
        points=points,
        confidence=confidence,
        world=np.zeros((len(BODY_LANDMARKS), 3), np.float32)
        if body is None
        else moved_along(body, points, tuple(joints)),
        spatial=body is not None,
        original=(width, height),
        people=np.array([person_box(one, rgb.shape) for one in people], np.float32).reshape(-1, 4)
        if sketched is None
        else _box_around(sketched),
        index=index,
        others=_covered([one for one in people if one is not body and not _same(one, body)], rgb.shape),
        face=None if body is None else _face(shown, points),
        hands=hands,
        drawn=sketched is not None,
        placed=tuple(joints),
    )
    legs = _check_whole(figure, partial, warn)
    check_posture(figure.points, figure.world if figure.spatial else None, legs, warn)
    return figure


def moved_along(body: Body, points: NDArray[np.float32], joints: Sequence[str]) -> NDArray[np.float32]:
    """A body's places in space (33, 3), those of joints that were moved by hand to points (33, 2) moved as far: otherwise what
    was believed before would hold against them. Their depth stays."""
    world = body.world.copy()
    moved = [BODY_LANDMARKS.index(name) for name in joints]
    metres = np.ptp(world[:, 1]) / max(float(np.ptp(body.points[:, 1])), 1.0)
    world[moved, :2] += metres * (points[moved] - body.points[moved]) * np.array([1, -1], np.float32)
    return np.asarray(world, np.float32)


def _chosen(
    rgb: NDArray[np.uint8], people: Sequence[Body], choice: Choice, scale: NDArray[np.float64]
) -> tuple[Body | None, int]:
    """The one who is meant, and their number among those found. `scale` (2,) as in `Figure`."""
    height, width = rgb.shape[:2]
    if choice.box is not None:
        x, y, wide, high = (float(value) for value in np.array(choice.box) * np.tile(scale, 2))
        if not (x < width and y < height and x + wide > 0 and y + high > 0):
            raise InputError(
                "person_box_outside",
                f"The person's box lies outside the picture: draw it within {width / scale[0]:.0f} x {height / scale[1]:.0f}.",
                ("person_box",),
            )
        body = find_body_within(
            rgb,
            (
                x - BOX_MARGIN_SHARE * wide,
                y - BOX_MARGIN_SHARE * high,
                (1 + 2 * BOX_MARGIN_SHARE) * wide,
                (1 + 2 * BOX_MARGIN_SHARE) * high,
            ),
        )
        return body, next((k for k, one in enumerate(people) if _same(one, body)), len(people))
    boxes = [(person_box(one, rgb.shape) / np.tile(scale, 2)).round().astype(int).tolist() for one in people]
    index = choice.index or 0
    if not people and index == 0:
        return None, 0
    if index >= len(people):
        raise InputError(
            "person_index_out_of_range",
            f"{len(people)} people were found in the picture: person_index counts from 0.",
            ("person_index", "person_box"),
            {"people": boxes},
        )
    if len(people) >= MIN_CROWD_PEOPLE and choice.index is None and not choice.placed:
        raise InputError(
            "crowd",
            f"The picture shows a crowd ({len(people)} people and more): choose the one who is meant, or draw a "
            "box around them.",
            ("person_index", "person_box"),
            {"people": boxes},
        )
    return people[index], index


def _sketched(rgb: NDArray[np.uint8], choice: Choice, scale: NDArray[np.float64]) -> NDArray[np.float32] | None:
    """The landmarks (33, 2) of a figure on plain paper that has a person's outline, in the box if there is one."""
    if choice.index not in (None, 0):
        return None
    height, width = rgb.shape[:2]
    x, y, wide, high = (0, 0, width, height) if choice.box is None else np.array(choice.box) * np.tile(scale, 2)
    left, top = max(0, int(x)), max(0, int(y))
    part = rgb[top : int(np.ceil(y + high)), left : int(np.ceil(x + wide))]
    outline = figure_on_paper(part) if min(part.shape[:2]) >= MIN_PERSON_HEIGHT_PIXELS else None
    points = None if outline is None else outline_skeleton(outline)
    return None if points is None else np.asarray(points + np.array([left, top]), np.float32)


def _box_around(points: NDArray[np.float32]) -> NDArray[np.float32]:
    """The box (1, 4) of all points (N, 2)."""
    return np.concatenate([points.min(0), np.ptp(points, axis=0)])[None].astype(np.float32)


def _face(rgb: NDArray[np.uint8], points: NDArray[np.float32]) -> NDArray[np.float32] | None:
    """The face (478, 3) at the head of a body whose landmarks (33, 2) are known, looked at closely."""
    height, width = rgb.shape[:2]
    at = {name: points[BODY_LANDMARKS.index(name)] for name in ("Nose", "LeftShoulder", "RightShoulder")}
    reach = max(8.0, 1.3 * float(np.linalg.norm(at["Nose"] - (at["LeftShoulder"] + at["RightShoulder"]) / 2)))
    x, y = at["Nose"]
    left, right = int(max(0, x - reach)), int(min(width, x + reach))
    top, bottom = int(max(0, y - reach)), int(min(height, y + reach))
    if right - left < 16 or bottom - top < 16:
        return None
    larger = max(1.0, FACE_CROP_PIXELS / (right - left))
    part = cv2.resize(rgb[top:bottom, left:right], None, fx=larger, fy=larger, interpolation=cv2.INTER_CUBIC)
    meshes = find_faces(np.ascontiguousarray(part, np.uint8), 1)
    if not meshes:
        return None
    mesh = meshes[0] / np.float32(larger)
    mesh[:, :2] += [left + 0.5 / larger - 0.5, top + 0.5 / larger - 0.5]
    return np.asarray(mesh, np.float32) if np.linalg.norm(mesh[1, :2] - at["Nose"]) < 0.4 * reach else None


def _hands(rgb: NDArray[np.uint8], body: Body) -> tuple[NDArray[np.float32] | None, NDArray[np.float32] | None]:
    """The hands (21, 3) at a body's wrists, looked at closely."""
    seen = {hand.side: np.column_stack([hand.points, hand.depth]) for hand in find_hands(rgb, body)}
    return seen.get(SIDE_NAMES[0]), seen.get(SIDE_NAMES[1])


def _same(one: Body, other: Body | None) -> bool:
    """Whether two findings are of one person."""
    if other is None:
        return False
    away = np.median(np.linalg.norm(one.points - other.points, axis=1))
    return bool(away < 0.15 * np.ptp(one.points, axis=0).max())


def _covered(people: Sequence[Body], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    covered = np.zeros(shape[:2], np.bool_)
    for one in people:
        covered |= covered_by(one, (shape[0], shape[1]))
    return covered


def _check_whole(figure: Figure, partial: bool, warn: Callable[[str, str], None]) -> bool:
    """Refuse who is not to be seen; whether the knees are."""
    height, width = figure.rgb.shape[:2]
    limit = np.array([width, height])
    off = np.abs(figure.points / limit - 0.5).max(axis=1)
    seen = {
        name for i, name in enumerate(BODY_LANDMARKS) if off[i] < 0.55 and figure.confidence[i] > MIN_JOINT_CONFIDENCE
    }
    nose = BODY_LANDMARKS.index("Nose")
    if (
        off[nose] > 0.5 and figure.confidence[nose] > MIN_JOINT_CONFIDENCE
    ):  # the network guesses a head that the picture cuts off
        raise InputError(
            "not_full_body",
            "The person's head is cut off by the picture's edge: choose a picture that shows it.",
            ("joints",),
        )
    if missing := [name for name in SHOULDER_JOINTS if name not in seen]:
        raise InputError(
            "not_full_body",
            f"The person's shoulders are not to be seen ({in_words(missing)}): choose a picture of the whole body.",
            ("joints",),
        )
    if missing := [name for name in LOWER_BODY_JOINTS if name not in seen]:
        if not partial:
            raise InputError(
                "not_full_body",
                f"The person is cut off or hidden below ({in_words(missing)}): choose a picture of the whole body, or "
                "accept a person who is cut off or hidden below the chest (the option “partial”).",
                ("partial", "joints"),
            )
        warn("not_full_body", f"The person is cut off or hidden below ({in_words(missing)}).")
    shown = figure.points[[BODY_LANDMARKS.index(name) for name in seen], 1]
    if np.ptp(shown) < MIN_PERSON_HEIGHT_PIXELS:
        raise InputError(
            "person_too_small",
            f"The person is {np.ptp(shown):.0f} pixels high: choose a picture in which it is {MIN_PERSON_HEIGHT_PIXELS} or more.",
            ("joints", "person_box"),
        )
    return seen >= {"LeftKnee", "RightKnee"}
