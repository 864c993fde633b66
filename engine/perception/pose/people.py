"""All the people of a picture, though the network of body poses sees but one. Each that was found is painted over, and
the network looks again. It also looks closely below every face that belongs to none of those found."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.imaging.masks.mask_distance import dilate_mask
from engine.perception.face.faces import find_faces
from engine.perception.pose.body import BODY_LANDMARKS, FAINT_CONFIDENCE, Body, find_body

MAX_DETECTED_PEOPLE = 12
"""People that are looked for, at most."""
LIMB_LINES = tuple(
    (f"{side}{a}", f"{side}{b}")
    for side in SIDE_NAMES
    for a, b in (
        *(("Shoulder", "Elbow"), ("Elbow", "Wrist"), ("Wrist", "Index"), ("Shoulder", "Hip")),
        *(("Hip", "Knee"), ("Knee", "Ankle"), ("Ankle", "FootIndex")),
    )
)
"""The lines along which a body's limbs lie."""
LIMB_WIDTH = 0.1
"""Width of a limb, as a share of the height from nose to ankles."""
HEAD_RADIUS_NECK_LENGTHS = 0.75
"""Radius of the head, in distances between nose and the middle of the shoulders."""
MIN_TRUNK_CONFIDENCE = 0.5
"""Mean confidence of shoulders and hips from which a further body is believed."""
MIN_DISTANCE_SHARE = 0.15
"""How far from one another two bodies' points are at least, in the median, as a share of their size."""
WIDE_PICTURE_ASPECT = 1.4
"""Width over height from which a picture is wide."""
MIN_SQUARE_PIXELS = 64
"""Pixels of a side: in less, no character can be made of anybody, and a strip would be looked at in a thousand squares."""
MAX_COVERED_SHARE = 0.5
"""Share of a further body's points that may lie on one found before."""
CLOSER_MARGIN_SHARE = 0.35
"""How much more than the box of somebody faint is looked at again, as a share of its sides: a body is found there once more, a
rocket is not."""

FACE_REACHES = ((4.0, 8.5), (3.6, 8.0))
"""Sizes of a face to either side of it, and below, in which its body is looked for: one that is there is found in both parts, what a network sees
into a wall is not."""


def find_people(rgb: NDArray[np.uint8], most: int = MAX_DETECTED_PEOPLE) -> list[Body]:
    """The bodies in a picture (H, W, 3) uint8, the largest first."""
    found: list[Body] = []
    remaining = np.ascontiguousarray(rgb).copy()
    covered = np.zeros(rgb.shape[:2], np.bool_)
    while len(found) < most and (body := find_body(remaining)) is not None:
        if found and not _is_another(body, found, covered):
            break
        found.append(body)
        covered |= _paint_over(remaining, body)
    for another in (find_body_within(rgb, box) for box in _squares(rgb.shape)):
        if len(found) < most and another is not None and _is_another(another, found, None):
            found.append(another)
    for face in find_faces(rgb, most):
        another = _below(rgb, face[:, :2], FACE_REACHES[0])
        if len(found) < most and another is not None and _is_another(another, found, None):
            again = _below(rgb, face[:, :2], FACE_REACHES[1])
            if again is not None and _are_one(another, again):
                found.append(another)
    if not found and most > 0 and (body := _faint(rgb)) is not None:
        found.append(body)
    return sorted(found, key=lambda body: -float(np.prod(person_box(body, rgb.shape)[2:])))


def _faint(rgb: NDArray[np.uint8]) -> Body | None:
    """Somebody who hardly stands out, in camouflage for instance: whom two looks find at the same place."""
    body = find_body(rgb, FAINT_CONFIDENCE)
    if body is None:
        return None
    x, y, wide, high = person_box(body, rgb.shape)
    box = (
        x - CLOSER_MARGIN_SHARE * wide,
        y - CLOSER_MARGIN_SHARE * high,
        (1 + 2 * CLOSER_MARGIN_SHARE) * wide,
        (1 + 2 * CLOSER_MARGIN_SHARE) * high,
    )
    again = find_body_within(rgb, box, FAINT_CONFIDENCE)
    return body if again is not None and _are_one(body, again) else None


def person_box(body: Body, shape: tuple[int, ...]) -> NDArray[np.float32]:
    """The box around a body within a picture of a shape (H, W, ...): x, y, width and height, hair and feet included."""
    points = body.points
    reach = HEAD_RADIUS_NECK_LENGTHS * _neck(body)
    low = np.minimum(points.min(0), body.landmark("Nose") - [reach, 1.6 * reach]) - LIMB_WIDTH / 3 * np.ptp(
        points[:, 1]
    )
    high = np.maximum(points.max(0), body.landmark("Nose") + reach) + LIMB_WIDTH / 3 * np.ptp(points[:, 1])
    low, high = np.maximum(low, 0), np.minimum(high, [shape[1], shape[0]])
    return np.concatenate([low, np.maximum(high - low, 1)]).astype(np.float32)


def covered_by(body: Body, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Where a body surely is (H, W): its limbs, trunk and head."""
    drawn = np.zeros(shape, np.uint8)
    at = {name: tuple(int(value) for value in np.rint(body.landmark(name))) for name in BODY_LANDMARKS}
    width = max(1, round(LIMB_WIDTH * float(np.ptp(body.points[:, 1]))))
    for a, b in LIMB_LINES:
        cv2.line(drawn, at[a], at[b], (1,), width)
    trunk = np.array([at[f"{side}{joint}"] for side, joint in _TRUNK_CORNERS])
    cv2.fillPoly(drawn, [trunk], (1,))
    cv2.circle(drawn, at["Nose"], max(1, round(HEAD_RADIUS_NECK_LENGTHS * _neck(body))), (1,), -1)
    return drawn > 0


_TRUNK_CORNERS = (("Left", "Shoulder"), ("Right", "Shoulder"), ("Right", "Hip"), ("Left", "Hip"))


def _neck(body: Body) -> float:
    """Pixels from the nose to the middle of the shoulders."""
    return float(
        np.linalg.norm(body.landmark("Nose") - (body.landmark("LeftShoulder") + body.landmark("RightShoulder")) / 2)
    )


def _paint_over(rgb: NDArray[np.uint8], body: Body) -> NDArray[np.bool_]:
    """Take a body out of the picture, in place, and say where it was."""
    mask = covered_by(body, (rgb.shape[0], rgb.shape[1]))
    wide = dilate_mask(mask, max(2, mask.shape[0] // 200))
    rest = ~wide
    rgb[wide] = rgb[rest].mean(0) if rest.any() else 128
    return wide


def _is_another(body: Body, found: list[Body], covered: NDArray[np.bool_] | None) -> bool:
    """Whether a body is believable, and none of those found before."""
    trunk = [BODY_LANDMARKS.index(f"{side}{joint}") for side, joint in _TRUNK_CORNERS]
    if body.confidence[trunk].mean() < MIN_TRUNK_CONFIDENCE:
        return False
    if covered is not None:
        height, width = covered.shape
        at = np.rint(body.points).astype(int)
        inside = (at >= 0).all(1) & (at < [width, height]).all(1)
        if not inside.any() or covered[at[inside, 1], at[inside, 0]].mean() > MAX_COVERED_SHARE:
            return False
    for other in found:
        if _are_one(body, other):
            return False
        if np.linalg.norm(body.landmark("Nose") - other.landmark("Nose")) < max(_neck(body), _neck(other)):
            return False
    return True


def _are_one(body: Body, other: Body) -> bool:
    """Whether two bodies are at one place."""
    size = float(np.ptp(body.points, axis=0).max())
    return bool(np.median(np.linalg.norm(body.points - other.points, axis=1)) < MIN_DISTANCE_SHARE * size)


def _squares(shape: tuple[int, ...]) -> list[tuple[float, float, float, float]]:
    """Squares that cover a wide picture, one overlapping the next by half: the network makes every picture a small square,
    in which the people of a wide one are tiny."""
    height, width = shape[:2]
    if width < WIDE_PICTURE_ASPECT * height or height < MIN_SQUARE_PIXELS:
        return []
    count = int(np.ceil(2 * (width - height) / height)) + 1
    return [(left, 0, height, height) for left in np.linspace(0, width - height, count)]


def _below(rgb: NDArray[np.uint8], face: NDArray[np.float32], reach: tuple[float, float]) -> Body | None:
    """The body that a face belongs to, looked for in a part of the picture that begins above it and reaches so many of its sizes to
    either side, and down."""
    height, width = rgb.shape[:2]
    low, high = face.min(0), face.max(0)
    middle, size = (low + high) / 2, float((high - low).max())
    left, right = int(max(0, middle[0] - reach[0] * size)), int(min(width, middle[0] + reach[0] * size))
    top, bottom = int(max(0, low[1] - size)), int(min(height, high[1] + reach[1] * size))
    if right - left < 16 or bottom - top < 16:
        return None
    body = find_body_within(rgb, (left, top, right - left, bottom - top))
    return body if body is not None and np.linalg.norm(body.landmark("Nose") - middle) < size else None


def find_body_within(
    rgb: NDArray[np.uint8], box: tuple[float, float, float, float], confidence: float = 0.5
) -> Body | None:
    """The most prominent body of a part of a picture: x, y, width and height in pixels. In pixels of the whole."""
    x, y, wide, high = box
    left, top = int(max(0, x)), int(max(0, y))
    part = rgb[top : int(np.ceil(y + high)), left : int(np.ceil(x + wide))]
    if min(part.shape[:2]) < 16:
        return None
    body = find_body(np.ascontiguousarray(part), confidence)
    return None if body is None else Body(body.points + np.array([left, top], np.float32), body.world, body.confidence)
