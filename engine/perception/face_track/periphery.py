"""Peripheral points of the driver, tracked around head and shoulders (section 4, Bouguet 2001)."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import Similarity, fit_similarity
from engine.perception.face_track.held_face import EASE_BACK_FRAMES, return_share
from engine.perception.masks.segmentation import selfie_mask

MAX_POINTS = 100
TRACKED_HEIGHT_PIXELS = 360
"""Frames are tracked at about this height; points outside the face need no more."""
MAX_FORWARD_BACKWARD_PIXELS = 1.0
"""A point that does not come back to within this many working pixels is not trusted in that frame."""
MAX_DRIFT_PIXELS = 3.0
"""How far, in working pixels, the match against the first frame may be from the frame-to-frame track."""
MAX_DRIFT_PIXELS_AFTER_LOSS = 12.0
"""How far, in working pixels, the match against the first frame may be from where the face would carry the point, after
frames without a face."""
FLOW_WINDOW = (21, 21)
TRACKING_PYRAMID_LEVELS = 2
"""Levels of the pyramid above the frame for a match from one frame to the next."""
ANCHOR_PYRAMID_LEVELS = 1
"""Levels of the pyramid above the frame for a match against the first frame: the track says about where it is."""
FADE_FRAMES = 17
"""Frames over which a point that is lost, or found again, loses or gains its say."""
MATCH_TERMINATION = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 10, 0.03)
"""A match is found after so many steps, or when a step is shorter than so many working pixels."""


class PeripheryTracker:
    """Follows points from the first frame that shows a face: frame to frame, then anchored to the first."""

    def __init__(self) -> None:
        self._scale = 1.0
        self._first: NDArray[np.uint8] | None = None
        self._last: NDArray[np.uint8] | None = None
        self._start = np.zeros((0, 2), np.float32)
        self._face = np.zeros((0, 2))
        self._broken = np.zeros(0, bool)
        self._points: list[NDArray[np.float32]] = []
        self._tracked: list[NDArray[np.bool_]] = []
        self._trusted: list[NDArray[np.bool_]] = []
        self._before = 0

    def follow(self, rgb: NDArray[np.uint8], mesh: NDArray[np.float32] | None) -> None:
        """Take in the next frame; `mesh` is its face, None where none was found."""
        if self._first is None:
            if mesh is None:
                self._before += 1
                return
            self._scale = min(1.0, TRACKED_HEIGHT_PIXELS / rgb.shape[0])
            self._first = self._last = self._grey(rgb)
            self._start = _choose(rgb, mesh, self._scale)
            self._face = self._small(mesh)
            self._broken = np.zeros(len(self._start), bool)
            self._points = [self._start]
            self._tracked = [np.ones(len(self._start), bool)]
            self._trusted = self._tracked.copy()
            return
        grey = self._grey(rgb)
        carry = None if mesh is None else fit_similarity(self._face, self._small(mesh))
        points, good = self._step(grey, carry) if len(self._start) else (self._start, self._broken)
        self._points.append(points)
        self._tracked.append(good)
        self._trusted.append(self._trusted[-1] if mesh is None else good)
        self._last = grey

    def result(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """(N, K, 2) positions in pixels of the frame and (N, K) how far they are trusted, see `tracked_weights`: without a face as
        far as before, so that all holds still."""
        if not len(self._start):
            frames = self._before + len(self._points)
            return np.zeros((frames, 0, 2), np.float32), np.zeros((frames, 0), np.float32)
        points = np.array([self._points[0]] * self._before + self._points, np.float32)
        tracked, trusted = (np.array([given[0]] * self._before + given) for given in (self._tracked, self._trusted))
        return (ease_returns(points, tracked) + 0.5) / self._scale - 0.5, tracked_weights(trusted)

    def _grey(self, rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
        grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)
        if self._scale < 1:
            grey = cv2.resize(grey, None, fx=self._scale, fy=self._scale, interpolation=cv2.INTER_AREA)
        return np.asarray(grey, np.uint8)

    def _small(self, mesh: NDArray[np.float32]) -> NDArray[np.float64]:
        """The mesh's places in working pixels, (478, 2)."""
        return np.asarray((mesh[:, :2] + 0.5) * self._scale - 0.5, float)

    def _step(self, grey: NDArray[np.uint8], carry: Similarity | None) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
        """Where the points are in the next frame, and whether they are found there. Nothing follows them through a frame
        without a face: they stay where they were, until they are found where the face, moved by `carry` from the first
        frame, takes them."""
        assert self._last is not None and self._first is not None
        last = self._points[-1]
        if carry is None:
            self._broken[:] = True
            return last, np.zeros(len(last), bool)
        moved, good = _match(self._last, grey, last, last, TRACKING_PYRAMID_LEVELS)
        good &= ~self._broken
        moved[self._broken] = carry(self._start[self._broken])
        # against the first frame, from where the track is now: takes the drift out
        anchored, sound = _match(self._first, grey, self._start, moved, ANCHOR_PYRAMID_LEVELS)
        sound &= np.linalg.norm(anchored - moved, axis=1) < np.where(
            self._broken, MAX_DRIFT_PIXELS_AFTER_LOSS, MAX_DRIFT_PIXELS
        )
        sound &= _comes_back(self._first, grey, self._start, anchored, ANCHOR_PYRAMID_LEVELS)
        self._broken &= ~sound
        loose = ~sound
        if loose.any():
            good[loose] &= _comes_back(self._last, grey, last[loose], moved[loose], TRACKING_PYRAMID_LEVELS)
            moved[loose & ~good] = last[loose & ~good]
        return np.where(sound[:, None], anchored, moved).astype(np.float32), good | sound


def ease_returns(points: NDArray[np.float32], tracked: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(N, K, 2): a point that is found again goes over from where it was lost, at the pace of a face that comes back."""
    eased, lost = points.copy(), points[0]
    since = np.full(points.shape[1], EASE_BACK_FRAMES + 1)
    for i in range(1, len(points)):
        lost = np.where((tracked[i] | ~tracked[i - 1])[:, None], lost, eased[i - 1])
        since = np.where(tracked[i], since + 1, 0)
        eased[i] = lost + return_share(since)[:, None] * (points[i] - lost)
    return eased


def tracked_weights(tracked: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(N, K) in [0, 1]: whether each point is tracked, averaged over `FADE_FRAMES` frames around: what comes or goes, does so
    without a jump."""
    box = np.ones((FADE_FRAMES, 1), np.float32) / FADE_FRAMES
    return np.asarray(cv2.filter2D(tracked.astype(np.float32), -1, box, borderType=cv2.BORDER_REPLICATE), np.float32)


def _match(
    a: NDArray[np.uint8], b: NDArray[np.uint8], points: NDArray[np.float32], guess: NDArray[np.float32], levels: int
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Where the surroundings of `points` (K, 2) in `a` are in `b`, looked for from `guess` on; and whether they were found."""
    there, found, _ = cv2.calcOpticalFlowPyrLK(
        a,
        b,
        points[:, None],
        guess[:, None].copy(),
        winSize=FLOW_WINDOW,
        maxLevel=levels,
        criteria=MATCH_TERMINATION,
        flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
    )
    return np.asarray(there[:, 0], np.float32), np.asarray(found[:, 0] == 1)


def _comes_back(
    a: NDArray[np.uint8], b: NDArray[np.uint8], points: NDArray[np.float32], there: NDArray[np.float32], levels: int
) -> NDArray[np.bool_]:
    """The forward-backward check: whether what was matched from `a` to `there` in `b` is matched back."""
    back, found = _match(b, a, there, points, levels)
    return found & (np.linalg.norm(back - points, axis=1) < MAX_FORWARD_BACKWARD_PIXELS)


def _choose(rgb: NDArray[np.uint8], mesh: NDArray[np.float32], scale: float) -> NDArray[np.float32]:
    """Good features on the person, outside the face, at working scale (K, 2)."""
    small = np.asarray(cv2.resize(rgb, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA) if scale < 1 else rgb)
    mask = (selfie_mask(np.asarray(small, np.uint8)) > 0.8).astype(np.uint8)
    cv2.fillConvexPoly(mask, cv2.convexHull((mesh[:, :2] * scale).round().astype(np.int32)), 0)
    mask = np.asarray(cv2.erode(mask, np.ones((5, 5), np.uint8)), np.uint8)
    grey = cv2.cvtColor(small, cv2.COLOR_RGB2GRAY)
    found = cv2.goodFeaturesToTrack(grey, MAX_POINTS, 0.01, 0.02 * np.hypot(*grey.shape), mask=mask)
    return np.zeros((0, 2), np.float32) if found is None else found[:, 0].astype(np.float32)
