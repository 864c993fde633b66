"""One of a video's faces, followed."""

from __future__ import annotations

from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from engine.perception.faces import FaceTracker, find_faces, several_faces

REACH = 0.75
"""A face that is further from where the followed one was last seen, in its own size, is somebody else's."""


class OneFace:
    """Follows one face of a video, frame by frame: of those in the first frame that shows any, the `index`-th from the
    largest on, 0 is the largest. `boxes` (F, 4) are those faces as x, y, width, height in pixels, the largest first. Where
    there is one alone, whoever is seen when it has gone is taken for it.

    Use as a context manager.
    """

    def __init__(self, index: int = 0) -> None:
        self._tracker = FaceTracker()
        self._index = index
        self._last: NDArray[np.float32] | None = None
        self._among_others = False
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
        seen = self._tracker(rgb)
        if seen and self._last is None:
            seen = self._choose(rgb, seen)
        mesh = min(seen, key=self._away) if seen else None
        if mesh is None or (self._among_others and self._away(mesh) > REACH):
            return None
        self._last = mesh
        return mesh

    def _choose(self, rgb: NDArray[np.uint8], seen: list[NDArray[np.float32]]) -> list[NDArray[np.float32]]:
        """What a tracker of as many faces as there are sees, once it is known which one is meant."""
        if several := bool(self._index) or several_faces(rgb):
            seen = find_faces(rgb) or seen
        self.boxes = np.array([[*m[:, :2].min(axis=0), *np.ptp(m[:, :2], axis=0)] for m in seen], np.float32)
        self._last = seen[self._index]
        if not several:
            return seen
        self._among_others = True
        self._tracker.__exit__(None, None, None)
        self._tracker = FaceTracker(len(seen))
        return self._tracker(rgb)

    def _away(self, mesh: NDArray[np.float32]) -> float:
        """How far a mesh is from where the face was last seen, in that one's size."""
        if self._last is None:
            return 0.0
        apart = np.linalg.norm(mesh[:, :2].mean(axis=0) - self._last[:, :2].mean(axis=0))
        return float(apart / np.sqrt(np.prod(np.ptp(self._last[:, :2], axis=0))))
