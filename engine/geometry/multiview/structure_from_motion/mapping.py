"""Incremental mapping: two pictures begin, the others join one by one, and everything is adjusted as it grows.

Source: Schoenberger and Frahm, Structure-from-Motion Revisited, CVPR 2016, sections 2 and 4.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.multiview.bundle import Bundle, Observations, reprojection_errors, undistorted
from engine.geometry.multiview.bundle_adjustment import Freedom, adjust
from engine.geometry.multiview.structure_from_motion.poses import Pose, relative_pose, resection
from engine.geometry.multiview.structure_from_motion.tracks import PairMatches, Tracks, join_tracks
from engine.geometry.multiview.structure_from_motion.triangulation import triangulate

MAX_ERROR_PIXELS = 3.0
"""Pixels that an observation may be off, of pictures 1000 pixels long."""
MAX_FIRST_ERROR_PIXELS = 8.0
"""Pixels that an observation by a camera that was not adjusted yet may be off, of pictures 1000 pixels long."""
MIN_RAY_ANGLE_RADIANS = np.radians(2.0)
"""Radians between two rays to a point, at least; below, its distance says little."""
MIN_KNOWN_POINTS = 15
"""Known points by which a camera joins, at least."""
MIN_FIRST_PAIR_RADIANS = np.radians(6.0)
"""Median angle of the points of the first two pictures: their distance has to be sure."""
MAX_FIRST_PAIRS = 30
"""Pairs of pictures, those with most matches first, of which one may begin."""
GLOBAL_ADJUSTMENT_GROWTH = 1.25
"""By what the number of cameras grows until all are adjusted again."""
LOCAL_CAMERA_COUNT = 6
"""Cameras adjusted when one joins: it, and those that share most points with it."""
MAX_BEGINNINGS = 3
"""Beginnings that are tried while the cameras are not enough."""
ENOUGH_CAMERAS_SHARE = 0.9
"""Share of the pictures."""
MIN_FOCAL_CAMERAS, MIN_DISTORTION_CAMERAS = 4, 10
"""Cameras from which the focal length, and the distortion, can be told."""


@dataclass(frozen=True)
class Lens:
    """What is known of a clip's lens.

    parameters : (3,) focal length in pixels, k1, k2.
    centre : (2,) the principal point.
    known : to be kept as they are.
    """

    parameters: NDArray[np.float64]
    centre: NDArray[np.float64]
    known: bool = False


@dataclass(frozen=True)
class Reconstruction:
    """What was found of C pictures and T tracks with O observations.

    bundle : cameras of all pictures, points of all tracks (NaN where there is none).
    registered : (C,) bool, the pictures whose camera is found.
    tracks : the features of each track.
    seen : (O,) observations, those of the tracks in their order.
    agreed : (O,) bool, those in accord with the bundle.
    """

    bundle: Bundle
    registered: NDArray[np.bool_]
    tracks: Tracks
    seen: Observations
    agreed: NDArray[np.bool_]

    @property
    def solved(self) -> NDArray[np.bool_]:
        """(T,) the tracks whose point is found."""
        return np.isfinite(self.bundle.points[:, 0])


def reconstruct(
    features: Sequence[NDArray[np.floating]],
    pairs: Sequence[PairMatches],
    lens: Lens,
    tick: Callable[[float], None] = lambda fraction: None,
) -> Reconstruction | None:
    """Cameras of as many pictures as can be found, and points; None where no two pictures can begin.

    Where a beginning reaches few of them, another is tried, with the lens that came of the best so far.

    Parameters
    ----------
    features : of each picture (F, 2) pixels.
    pairs : matches, most of them right.
    lens : of all the pictures.
    tick : is told the share of pictures that have joined.
    """
    tracks = join_tracks(pairs, [len(found) for found in features])
    best: Reconstruction | None = None
    tried = np.zeros(len(features), np.bool_)
    for _ in range(MAX_BEGINNINGS):
        found = _grow(
            _Mapping(features, tracks, lens), [one for one in pairs if not tried[[one.first, one.second]].all()], tick
        )
        if found is None:
            break
        tried |= found.registered
        if best is None or found.registered.sum() > best.registered.sum():
            best = found
        if best.registered.sum() >= ENOUGH_CAMERAS_SHARE * len(features):
            break
        if not lens.known and best.registered.sum() > MIN_FOCAL_CAMERAS:
            lens = replace(lens, parameters=best.bundle.lenses[0] * [1, 0, 0])
    return best


def _grow(growing: _Mapping, beginnings: Sequence[PairMatches], tick: Callable[[float], None]) -> Reconstruction | None:
    """All that can be reached from one of the beginnings."""
    if not growing.begin(beginnings):
        return None
    adjusted_at = 2
    while growing.join_next():
        count = int(growing.registered.sum())
        tick(count / len(growing.registered))
        if count >= GLOBAL_ADJUSTMENT_GROWTH * adjusted_at or count <= MIN_FOCAL_CAMERAS + 1:
            growing.adjust_all()
            adjusted_at = count
        else:
            growing.adjust_around(growing.latest)
    for _ in range(2):
        growing.adjust_all(20)
    return growing.result()


class _Mapping:
    """A reconstruction that grows. Observations are those of the tracks, sorted by track; `kept` are those that agree."""

    def __init__(self, features: Sequence[NDArray[np.floating]], tracks: Tracks, lens: Lens):
        self.tracks, self.lens = tracks, lens
        pixels = np.concatenate([np.zeros((0, 2)), *(np.asarray(one, np.float64)[:, :2] for one in features)])
        begins = np.concatenate([[0], np.cumsum([len(one) for one in features])]).astype(np.intp)
        self.seen = Observations(tracks.image, tracks.track, pixels[begins[tracks.image] + tracks.feature])
        count = len(features)
        self.bundle = Bundle(
            np.tile(np.eye(3), (count, 1, 1)),
            np.zeros((count, 3)),
            lens.parameters[None].astype(np.float64),
            lens.centre[None].astype(np.float64),
            np.zeros(count, np.intp),
            np.full((tracks.count, 3), np.nan),
        )
        extent = float(pixels.max()) if len(pixels) else 1.0
        self.max_error = MAX_ERROR_PIXELS * extent / 1000
        self.max_first_error = MAX_FIRST_ERROR_PIXELS * extent / 1000
        self.registered = np.zeros(count, np.bool_)
        self.kept = np.zeros(len(self.seen), np.bool_)
        self.refused = np.zeros(count, np.intp)  # points known when a camera could not join
        self.latest = 0
        self._flatten()

    @property
    def solved(self) -> NDArray[np.bool_]:
        """(T,) the tracks whose point is known."""
        return np.isfinite(self.bundle.points[:, 0])

    @property
    def focal(self) -> float:
        """Pixels."""
        return float(self.bundle.lenses[0, 0])

    def begin(self, pairs: Sequence[PairMatches]) -> bool:
        """The first two cameras: of the pairs with most matches the one with most that agree, under a wide enough angle."""
        best: tuple[float, PairMatches, Pose] | None = None
        for pair in sorted(pairs, key=lambda one: -len(one.matches))[:MAX_FIRST_PAIRS]:
            shared = self._shared(pair)
            pose = relative_pose(
                self.flat[shared[:, 0]], self.flat[shared[:, 1]], self.max_first_error / 4 / self.focal
            )
            if pose is None:
                continue
            angle = self._median_angle(pose, shared)
            score = int(pose.agreed.sum()) * min(1.0, angle / MIN_FIRST_PAIR_RADIANS) ** 2
            if best is None or score > best[0]:
                best = score, pair, pose
        if best is None:
            return False
        _, pair, pose = best
        self._place(pair.second, pose)
        self.registered[pair.first] = True
        self.latest = pair.second
        self.solve_points(np.ones(self.tracks.count, np.bool_))
        return bool(self.solved.sum() >= MIN_KNOWN_POINTS)

    def join_next(self) -> bool:
        """One more camera, that sees most of the known points; False where none can."""
        while True:
            known = self.solved[self.seen.point]
            counts = np.bincount(self.seen.camera[known], minlength=len(self.registered))
            open_ones = ~self.registered & (counts >= MIN_KNOWN_POINTS) & (counts > 1.1 * self.refused)
            if not open_ones.any():
                return False
            image = int(np.argmax(np.where(open_ones, counts, -1)))
            chosen = np.flatnonzero(known & (self.seen.camera == image))
            pose = resection(
                self.bundle.points[self.seen.point[chosen]], self.flat[chosen], self.max_first_error / self.focal
            )
            if pose is None or pose.agreed.sum() < max(MIN_KNOWN_POINTS, 0.15 * len(chosen)):
                self.refused[image] = counts[image]
                continue
            self._place(image, pose)
            self.latest = image
            self.kept[chosen] = pose.agreed
            seen_here = np.zeros(self.tracks.count, np.bool_)
            seen_here[self.seen.point[self.seen.camera == image]] = True
            self.solve_points(seen_here & ~self.solved)
            return True

    def solve_points(self, wanted: NDArray[np.bool_]) -> None:
        """Points for those of the tracks (T,) that are wanted, from the cameras found so far."""
        chosen = np.flatnonzero(wanted[self.seen.point] & self.registered[self.seen.camera])
        often = np.bincount(self.seen.point[chosen], minlength=self.tracks.count)
        chosen = chosen[often[self.seen.point[chosen]] >= 2]
        if not len(chosen):
            return
        track = self.seen.point[chosen]
        starts = np.flatnonzero(np.r_[True, np.diff(track) > 0, True]).astype(np.intp)
        found = triangulate(
            *((self.bundle.rotations, self.bundle.translations), self.seen.camera[chosen], self.flat[chosen]),
            *(starts, self.max_error / self.focal, MIN_RAY_ANGLE_RADIANS),
        )
        points = self.bundle.points.copy()
        points[track[starts[:-1]]] = found.points
        self.bundle = replace(self.bundle, points=points)
        self.kept[chosen] = found.agreed

    def adjust_around(self, image: int) -> None:
        """The latest camera and those that share most points with it; all others stay."""
        mine = np.zeros(self.tracks.count, np.bool_)
        mine[self.seen.point[self.kept & (self.seen.camera == image)]] = True
        shared = np.bincount(self.seen.camera[self.kept & mine[self.seen.point]], minlength=len(self.registered))
        free = np.zeros(len(self.registered), np.bool_)
        free[np.argsort(-shared, kind="stable")[:LOCAL_CAMERA_COUNT]] = True
        free &= self.registered & (shared > 0)
        beheld = np.zeros(self.tracks.count, np.bool_)
        beheld[self.seen.point[self.kept & free[self.seen.camera]]] = True
        chosen = self.kept & beheld[self.seen.point]
        if not (self.registered & ~free)[self.seen.camera[chosen]].any():
            return self.adjust_all()
        self.bundle = adjust(self.bundle, self.seen[chosen], Freedom(free), most_steps=5, converged=1e-3).bundle
        self._prune(chosen)
        return None

    def adjust_all(self, most_steps: int = 8) -> None:
        """All cameras, points, and as much of the lens as so many cameras tell; then what agrees is chosen anew."""
        count = int(self.registered.sum())
        focal = count >= MIN_FOCAL_CAMERAS and not self.lens.known
        distortion = count >= MIN_DISTORTION_CAMERAS and not self.lens.known
        freedom = Freedom(self.registered, (focal, distortion, distortion))
        self.bundle = adjust(self.bundle, self.seen[self.kept], freedom, most_steps=most_steps, converged=1e-4).bundle
        self._flatten()
        self._choose()

    def result(self) -> Reconstruction:
        """What was found."""
        return Reconstruction(self.bundle, self.registered, self.tracks, self.seen, self.kept)

    def _choose(self) -> None:
        """Keep whatever agrees now, also of what did not before; give up points that fewer than two cameras see, and look
        for them anew."""
        candidates = np.flatnonzero(self.solved[self.seen.point] & self.registered[self.seen.camera])
        self.kept[:] = False
        self.kept[candidates] = reprojection_errors(self.bundle, self.seen[candidates]) <= self.max_error
        self._forget()
        self.solve_points(~self.solved)

    def _prune(self, chosen: NDArray[np.bool_]) -> None:
        """Drop of the chosen observations (O,) those that do not agree."""
        index = np.flatnonzero(chosen)
        self.kept[index] = reprojection_errors(self.bundle, self.seen[index]) <= self.max_first_error
        self._forget()

    def _forget(self) -> None:
        lost = np.bincount(self.seen.point[self.kept], minlength=self.tracks.count) < 2
        points = self.bundle.points.copy()
        points[lost] = np.nan
        self.bundle = replace(self.bundle, points=points)
        self.kept &= ~lost[self.seen.point]

    def _flatten(self) -> None:
        """What is seen, on the plane at distance 1, by the lens as it is known now."""
        flat = undistorted(self.seen.pixels, self.bundle.lenses[0], self.bundle.centres[0])
        self.flat = np.where(np.isfinite(flat), flat, 1e6)

    def _shared(self, pair: PairMatches) -> NDArray[np.intp]:
        """(M, 2) observations of one track each in both pictures."""
        first = np.flatnonzero(self.seen.camera == pair.first)
        second = np.flatnonzero(self.seen.camera == pair.second)
        _, a, b = np.intersect1d(self.seen.point[first], self.seen.point[second], True, return_indices=True)
        return np.stack([first[a], second[b]], axis=1)

    def _median_angle(self, pose: Pose, shared: NDArray[np.intp]) -> float:
        """Radians between the two rays to a point, the median of those that agree."""
        ends = []
        for side, turn in ((0, np.eye(3)), (1, pose.rotation)):
            rays = np.concatenate([self.flat[shared[pose.agreed, side]], np.ones((int(pose.agreed.sum()), 1))], axis=1)
            rays = rays @ turn
            ends.append(rays / np.linalg.norm(rays, axis=1, keepdims=True))
        return float(np.median(np.arccos(np.clip((ends[0] * ends[1]).sum(1), -1, 1))))

    def _place(self, image: int, pose: Pose) -> None:
        rotations, translations = self.bundle.rotations.copy(), self.bundle.translations.copy()
        rotations[image], translations[image] = pose.rotation, pose.translation
        self.bundle = replace(self.bundle, rotations=rotations, translations=translations)
        self.registered[image] = True
