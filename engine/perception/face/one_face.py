"""One of a video's faces, followed."""

from __future__ import annotations

from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.faces import FaceTracker, find_faces, several_faces

SAME_FACE_REACH = 0.75
"""A face that is further from where the followed one was last seen, in its own size, is somebody else's."""
REGION_HALF_SIDE_FACE_SIZES = 1.5
"""Half side of the part of a frame in which a face is followed that is too small in the whole, in its own size."""
MAX_OFFSET_FACE_SIZES = 0.5
"""How far a face may be from the middle of the part of the frame in which it is followed, in its own size, before the
part is laid anew."""


class OneFace:
    """Follows one face of a video, frame by frame: of those in the first frame that shows any, the `index`-th from the
    largest on, 0 is the largest. `boxes` (F, 4) are those faces as x, y, width, height in pixels, the largest first. Where
    there is one alone, whoever is seen when it has gone is taken for it. One that the tracker does not see in the whole frame is
    followed in a part around it.

    Use as a context manager.
    """

    def __init__(self, index: int = 0) -> None:
        self._tracker = FaceTracker()
        self._index = index
        self._last: NDArray[np.float32] | None = None
        self._among_others = False
        self._part: tuple[int, int, int, int] | None = None
        self._middle = np.zeros(2, np.float32)
        self.boxes = np.zeros((0, 4), np.float32)

    def __enter__(self) -> OneFace:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._tracker.__exit__(kind, error, trace)

    def __call__(self, rgb: NDArray[np.uint8]) -> NDArray[np.float32] | None:
        """The face's mesh in this frame, as `FaceTracker` gives it; None where it is not seen.

        Raises `IndexError` on the first frame with faces, if it shows no more than `index` of them.
        """
        seen = self._see(rgb)
        if seen and self._last is None:
            seen = self._choose(rgb, seen)
        mesh = min(seen, key=self._away) if seen else None
        if mesh is None or (self._among_others and self._away(mesh) > SAME_FACE_REACH):
            return None
        self._last = mesh
        if self._part is not None and self._away_from_middle(mesh) > MAX_OFFSET_FACE_SIZES:
            self._look_around(mesh, rgb.shape)
        return mesh

    def _see(self, rgb: NDArray[np.uint8]) -> list[NDArray[np.float32]]:
        if self._part is None:
            return self._tracker(rgb)
        x0, y0, x1, y1 = self._part
        return [mesh + np.array([x0, y0, 0], np.float32) for mesh in self._tracker(rgb[y0:y1, x0:x1])]

    def _choose(self, rgb: NDArray[np.uint8], seen: list[NDArray[np.float32]]) -> list[NDArray[np.float32]]:
        """What a tracker of as many faces as there are sees, once it is known which one is meant."""
        if several := bool(self._index) or several_faces(rgb):
            seen = find_faces(rgb) or seen
        self.boxes = np.array([[*m[:, :2].min(axis=0), *np.ptp(m[:, :2], axis=0)] for m in seen], np.float32)
        self._last = seen[self._index]
        if not several:
            return seen
        self._among_others = True
        self._begin()
        in_whole = self._see(rgb)
        if any(self._away(mesh) <= SAME_FACE_REACH for mesh in in_whole):
            return in_whole
        self._look_around(self._last, rgb.shape)
        return self._see(rgb)

    def _begin(self) -> None:
        """A tracker that knows of nothing yet, for as many faces as there are."""
        self._tracker.__exit__(None, None, None)
        self._tracker = FaceTracker(len(self.boxes))

    def _look_around(self, mesh: NDArray[np.float32], shape: tuple[int, ...]) -> None:
        """From now on see the part of a frame (H, W, ...) around this face alone."""
        low, high = mesh[:, :2].min(axis=0), mesh[:, :2].max(axis=0)
        reach = REGION_HALF_SIDE_FACE_SIZES * (high - low).max()
        x0, y0 = np.maximum((low + high) / 2 - reach, 0).astype(int).tolist()
        x1, y1 = np.minimum(np.ceil((low + high) / 2 + reach), shape[1::-1]).astype(int).tolist()
        self._part = x0, y0, x1, y1
        self._middle = (low + high) / 2
        self._begin()

    def _away_from_middle(self, mesh: NDArray[np.float32]) -> float:
        low, high = mesh[:, :2].min(axis=0), mesh[:, :2].max(axis=0)
        return float(np.linalg.norm((low + high) / 2 - self._middle) / (high - low).max())

    def _away(self, mesh: NDArray[np.float32]) -> float:
        """How far a mesh is from where the face was last seen, in that one's size."""
        if self._last is None:
            return 0.0
        apart = np.linalg.norm(mesh[:, :2].mean(axis=0) - self._last[:, :2].mean(axis=0))
        return float(apart / np.sqrt(np.prod(np.ptp(self._last[:, :2], axis=0))))
