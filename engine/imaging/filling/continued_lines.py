"""Straight lines that end at a hole, continued into it.

What stands behind a person is built of straight lines: frames, shelves, tiles, the edge of a door. Patches continue them
only roughly, and lose those that are thinner than a pixel of the small picture they start from. Here a line
(`engine.imaging.filling.straight_lines`) is laid through its own pixels to a fraction of one, and painted into the hole
with its profile, the colours across it. It is the structure propagation of Sun et al., "Image completion with structure
propagation", SIGGRAPH 2005, for lines that need no drawing by hand. One that goes on beyond the hole is carried through;
one that does not, as far as it is known to be straight.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.straight_lines import Line, lines_towards

MAX_NEIGHBOUR_COSINE = float(np.cos(np.deg2rad(12)))
"""Cosine of the angle from which on two lines that reach the hole side by side may both be."""
PROFILE_HALF_WIDTH_PIXELS = 5
"""Pixels on either side of a line that its profile holds."""
CORE_HALF_WIDTH_PIXELS = 2
"""Pixels on either side of a line that have to be known in every row."""
PROFILE_SAMPLES_PER_PIXEL = 2
"""Samples of a profile for each pixel across the line."""
MAX_SUPPORT_PIXELS = 96
"""Pixels along a line from which it is known, at most."""
MIN_SUPPORT_PIXELS = 20
"""Pixels along a line from which it is known, at least."""
MIN_EXPLAINED_SHARE = 0.6
"""Share of the pixels beside it that must look like a line: what crosses it does not."""
MIN_UNMATCHED_LENGTH_PIXELS = 30
"""Pixels of the least known length of a line that is not found again beyond the hole."""
MAX_RESIDUAL_VARIANCE_SHARE = 0.35
"""Share of a profile's variance by which a pixel's own may be off to look like it."""
MIN_CONTRAST_GREY_LEVELS = 10.0
"""Grey levels by which a line stands out, at least."""
MAX_CUT_ROWS = 3 * PROFILE_HALF_WIDTH_PIXELS
"""Rows across the hole's edge that may be cut by it: a line that runs along the edge has more."""
MIN_SLOPE_SHARE = 0.15
"""Share of a profile's steepest slope below which the line has ended."""


@dataclass(frozen=True)
class LineContinuation:
    """`picture` (H, W, 3) float32 with lines in the hole; `painted` (H, W), where."""

    picture: NDArray[np.float32]
    painted: NDArray[np.bool_]


@dataclass(frozen=True)
class _Scene:
    """`picture` (H, W, 3), the `hole` (H, W) in it, and (H, W) uint8 what interpolating `touched` by the hole would give."""

    picture: NDArray[np.float32]
    hole: NDArray[np.bool_]
    touched: NDArray[np.uint8]


@dataclass(frozen=True)
class _Canvas:
    """`picture` (H, W, 3), painted in place, and by how many grey levels what is painted `stands_out` (H, W)."""

    picture: NDArray[np.float32]
    stands_out: NDArray[np.float32]


@dataclass(frozen=True)
class _Strip:
    """The surroundings of a line, a row for each pixel along it from `start`.

    colours : (N, K, 3), not numbers in the hole.
    known : (N,) where the line and what is next to it are not in the hole.
    open : (N,) where the line itself is in it.
    """

    start: int
    colours: NDArray[np.float32]
    known: NDArray[np.bool_]
    open: NDArray[np.bool_]


@dataclass(frozen=True)
class _Side:
    """What is known of a line on one side of a hole: `rows` of its strip, from the hole on, that look like it; the
    `profile` (K, 3); how far it reaches, pixels."""

    rows: NDArray[np.intp]
    profile: NDArray[np.float32]
    length: int


def continue_lines(picture: NDArray[np.float32], hole: NDArray[np.bool_], reach: float) -> LineContinuation:
    """The picture (H, W, 3) with the straight lines that end at the hole (H, W) painted into it; up to `reach` pixels from
    its edge where a line is not found again beyond the hole."""
    if not hole.any() or hole.all():
        return LineContinuation(picture, np.zeros_like(hole))
    touched = cv2.dilate(hole.astype(np.uint8), np.ones((5, 5), np.uint8))
    scene = _Scene(picture, hole, np.asarray(touched, np.uint8))
    canvas = _Canvas(picture.copy(), np.zeros(hole.shape, np.float32))
    drawn: list[Line] = []
    for line in lines_towards(scene.picture, scene.hole, MIN_SUPPORT_PIXELS):
        if any(_beside(line, other) for other in drawn):
            continue  # the other edge of one that has two
        finer = _laid_through(scene, line)
        if finer is not None and not any(_beside(finer, other) for other in drawn):
            drawn.append(finer)
            _paint(scene, finer, reach, canvas)
    return LineContinuation(canvas.picture, canvas.stands_out > 0)


def _beside(line: Line, other: Line) -> bool:
    """Whether a line reaches the hole within the profile of another that runs much as it does."""
    near = abs((line.point - other.point) @ other.normal) < PROFILE_HALF_WIDTH_PIXELS - 1
    return bool(near and abs(line.direction @ other.direction) > MAX_NEIGHBOUR_COSINE)


def _laid_through(scene: _Scene, line: Line) -> Line | None:
    """The line moved and turned so that its profile is the same all along; none if it does not look like a line."""
    for _ in range(2):
        strip = _strip(scene, line)
        if strip is None:
            return None
        near = _near_the_hole(strip)
        if near.sum() < MIN_SUPPORT_PIXELS:
            return None
        rows = strip.colours[near].mean(axis=2)
        profile = _median(rows)
        if np.isnan(profile).any():
            return None
        slope = np.gradient(profile) * PROFILE_SAMPLES_PER_PIXEL
        level = rows - profile
        level = np.nan_to_num(level - np.nanmean(level, axis=1, keepdims=True))
        like = (level**2).mean(axis=1) < 2 * MAX_RESIDUAL_VARIANCE_SHARE * profile.var()
        if like.sum() < MIN_SUPPORT_PIXELS or np.ptp(profile) < MIN_CONTRAST_GREY_LEVELS:
            return None
        shift = np.clip(-(level @ slope) / max(float(slope @ slope), 1e-6), -1, 1)[like]
        t = (strip.start + np.flatnonzero(near))[like].astype(float)
        turn, move = np.polyfit(t, shift, 1)
        offsets = np.arange(len(slope)) / PROFILE_SAMPLES_PER_PIXEL - PROFILE_HALF_WIDTH_PIXELS
        move += float(offsets @ slope**2 / (slope @ slope))  # to the middle between both edges of a thin one
        direction = line.direction + turn * line.normal
        line = Line(line.point + move * line.normal, direction / np.linalg.norm(direction))
    return line


def _strip(scene: _Scene, line: Line) -> _Strip | None:
    """The line's surroundings within the picture; none if it only touches a corner."""
    size = np.array(scene.hole.shape[::-1])
    low, high = -np.inf, np.inf
    for axis in range(2):
        if abs(line.direction[axis]) > 1e-9:
            ends = (
                np.array([PROFILE_HALF_WIDTH_PIXELS, size[axis] - 1 - PROFILE_HALF_WIDTH_PIXELS]) - line.point[axis]
            ) / line.direction[axis]
            low, high = max(low, ends.min()), min(high, ends.max())
        elif not PROFILE_HALF_WIDTH_PIXELS <= line.point[axis] <= size[axis] - 1 - PROFILE_HALF_WIDTH_PIXELS:
            return None
    if high - low < MIN_SUPPORT_PIXELS:
        return None
    start, stop = int(np.ceil(low)), int(np.floor(high)) + 1
    across = (
        np.arange(
            -PROFILE_HALF_WIDTH_PIXELS * PROFILE_SAMPLES_PER_PIXEL,
            PROFILE_HALF_WIDTH_PIXELS * PROFILE_SAMPLES_PER_PIXEL + 1,
        )
        / PROFILE_SAMPLES_PER_PIXEL
    )
    t = np.arange(start, stop)
    xy = line.point + t[:, None, None] * line.direction + across[:, None] * line.normal
    x, y = (np.ascontiguousarray(xy[..., i], np.float32) for i in range(2))
    colours = cv2.remap(scene.picture, x, y, cv2.INTER_CUBIC)
    hidden = np.asarray(cv2.remap(scene.touched, x, y, cv2.INTER_NEAREST) > 0)
    colours[hidden] = np.nan
    known = ~hidden[:, np.abs(across) <= CORE_HALF_WIDTH_PIXELS].any(axis=1)
    middle = line.point + t[:, None] * line.direction
    column, row = middle.round().astype(int).T
    return _Strip(start, np.asarray(colours, np.float32), np.asarray(known), scene.hole[row, column])


def _near_the_hole(strip: _Strip) -> NDArray[np.bool_]:
    """Known rows within reach of those where the line is in the hole."""
    around = np.convolve(strip.open, np.ones(2 * MAX_SUPPORT_PIXELS + 1))[MAX_SUPPORT_PIXELS:-MAX_SUPPORT_PIXELS]
    return np.asarray(strip.known & (around > 0.5))


def _paint(scene: _Scene, line: Line, reach: float, canvas: _Canvas) -> None:
    """The line where it is in the hole. Where lines cross, that which stands out more is seen."""
    strip = _strip(scene, line)
    if strip is None:
        return
    steps = np.flatnonzero(np.diff(np.concatenate([[False], strip.open, [False]]).astype(np.int8)))
    for first, last in steps.reshape(-1, 2):
        before, after = _side(strip, first, -1), _side(strip, last - 1, 1)
        far = last - first
        if before is not None and after is not None and _alike(before.profile, after.profile):
            _stroke(scene.hole, strip, line, (first, last), (before, after), canvas)
            continue
        for side, other, end in ((before, after, first), (after, before, last)):
            if side is None or side.length < MIN_UNMATCHED_LENGTH_PIXELS:
                continue
            inside = first > 0 and last < len(strip.open)
            length = min(side.length, round(reach), far // 2 if inside or other is not None else far)
            span = (end, end + length) if side is before else (end - length, end)
            _stroke(scene.hole, strip, line, span, (side, side), canvas)


def _side(strip: _Strip, edge: int, step: int) -> _Side | None:
    """What is known of the line from row `edge` of the hole on in the direction `step`."""
    rows = np.arange(edge + step, -1 if step < 0 else len(strip.known), step)[: MAX_SUPPORT_PIXELS + MAX_CUT_ROWS]
    if not len(rows) or not strip.known[rows].any():
        return None
    begin = int(np.argmax(strip.known[rows]))
    if begin > MAX_CUT_ROWS:
        return None
    rows = rows[begin:][:MAX_SUPPORT_PIXELS]
    rows = rows[strip.known[rows]]
    profile = _median(strip.colours[rows[: 2 * MIN_SUPPORT_PIXELS]])
    if np.isnan(profile).any() or float(np.ptp(profile.mean(axis=1))) < MIN_CONTRAST_GREY_LEVELS:
        return None
    like = _looks_like(strip.colours[rows], profile)
    share = np.cumsum(like) / np.arange(1, len(rows) + 1)
    enough = np.flatnonzero(like & (share >= MIN_EXPLAINED_SHARE))
    if len(enough) < MIN_SUPPORT_PIXELS:
        return None
    last = int(enough[-1])
    return _Side(rows[: last + 1][like[: last + 1]], profile, abs(int(rows[last] - rows[0])) + 1)


def _median(rows: NDArray[np.float32]) -> NDArray[np.float32]:
    """The median of `rows` (N, ...) where they are numbers; no number where none is."""
    middle = (np.isfinite(rows).sum(axis=0, keepdims=True) - 1) // 2
    return np.asarray(np.take_along_axis(np.sort(rows, axis=0), middle, axis=0)[0])


def _looks_like(rows: NDArray[np.float32], profile: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Which rows (N, K, 3) have the profile (K, 3), but for their brightness."""
    apart = rows - profile
    apart = apart - np.nanmean(apart, axis=1, keepdims=True)
    spread = float((profile - profile.mean(axis=0)).var())
    return np.asarray(np.nanmean(apart**2, axis=(1, 2)) < MAX_RESIDUAL_VARIANCE_SHARE * spread)


def _alike(one: NDArray[np.float32], other: NDArray[np.float32]) -> bool:
    """Whether two profiles (K, 3) are of one line."""
    return bool(_looks_like(one[None], other)[0] and _looks_like(other[None], one)[0])


def _stroke(
    hole: NDArray[np.bool_],
    strip: _Strip,
    line: Line,
    span: tuple[int, int],
    sides: tuple[_Side, _Side],
    canvas: _Canvas,
) -> None:
    """Paint rows `span` of the strip, from one side's profile to the other's, with the grain of the first."""
    first, last = span
    begin, end = sides
    slope = np.abs(np.gradient((begin.profile + end.profile).mean(axis=1)))
    steep = np.flatnonzero(slope > MIN_SLOPE_SHARE * slope.max())
    low = max(steep[0] / PROFILE_SAMPLES_PER_PIXEL - PROFILE_HALF_WIDTH_PIXELS - 1.5, -PROFILE_HALF_WIDTH_PIXELS)
    high = min(steep[-1] / PROFILE_SAMPLES_PER_PIXEL - PROFILE_HALF_WIDTH_PIXELS + 1.5, PROFILE_HALF_WIDTH_PIXELS)
    ends = line.point + (strip.start + np.array([first, last - 1])[:, None]) * line.direction
    corners = (ends[:, None] + np.array([low, high])[:, None] * line.normal).reshape(-1, 2)
    x0, y0 = np.maximum(np.floor(corners.min(axis=0)).astype(int), 0)
    x1, y1 = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + 1, hole.shape[::-1])
    y, x = np.mgrid[y0:y1, x0:x1]
    away = np.stack([x, y], axis=-1) - line.point
    along, across = away @ line.direction - strip.start, away @ line.normal
    chosen = hole[y0:y1, x0:x1] & (along >= first - 0.5) & (along <= last - 0.5) & (across >= low) & (across <= high)
    if not chosen.any():
        return
    along, column = along[chosen], (across[chosen] + PROFILE_HALF_WIDTH_PIXELS) * PROFILE_SAMPLES_PER_PIXEL
    share = np.clip((along - first) / max(last - first, 1), 0, 1)[:, None]
    positions = np.arange(len(slope))
    of = [np.stack([np.interp(column, positions, s.profile[:, c]) for c in range(3)], axis=1) for s in (begin, end)]
    colours = (1 - share) * of[0] + share * of[1]
    off = np.stack(
        [np.interp(column, positions, s.profile.mean(axis=1) - _ramp(s.profile.mean(axis=1))) for s in (begin, end)]
    )
    colours += _grain(strip, begin, along - first, column)
    off = np.abs((1 - share[:, 0]) * off[0] + share[:, 0] * off[1]) + 1e-3
    rows, columns = y[chosen], x[chosen]
    wins = off > canvas.stands_out[rows, columns]
    canvas.picture[rows[wins], columns[wins]] = colours[wins]
    canvas.stands_out[rows[wins], columns[wins]] = off[wins]


def _ramp(profile: NDArray[np.float32]) -> NDArray[np.float32]:
    """Straight from a profile's (K,) one end to its other."""
    return np.linspace(profile[0], profile[-1], len(profile), dtype=np.float32)


def _grain(strip: _Strip, side: _Side, along: NDArray[np.float64], column: NDArray[np.float64]) -> NDArray[np.float32]:
    """What the known rows have beside their profile, run through to and fro: (N, 3)."""
    count = len(side.rows)
    back = np.abs(along.astype(int)) % (2 * count)
    row = side.rows[np.where(back < count, back, 2 * count - 1 - back)]
    rest = strip.colours[row, column.round().astype(int)] - side.profile[column.round().astype(int)]
    return np.asarray(np.clip(np.nan_to_num(rest), -MIN_CONTRAST_GREY_LEVELS, MIN_CONTRAST_GREY_LEVELS), np.float32)
