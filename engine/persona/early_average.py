"""The average of a collection while its photographs are looked at: it appears, and sharpens as more of them are found."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.export.still import write_still
from engine.perception.face.head_pose import canonical_face
from engine.perception.identity.descriptor import IdentityDistances
from engine.persona.collection.person import belonging
from engine.persona.collection.photo_face import PhotoFace
from engine.persona.collection.sorting import Choice, reasons_against
from engine.persona.texture.aligned_photos import align_photos
from engine.persona.texture.bare_skin import bared
from engine.persona.texture.texture_frame import texture_frame

AVERAGE_SIZE = (244, 194)
"""Height and width, pixels."""
BACKGROUND_COLOUR = (58, 60, 64)
"""Around the face, as around the puppet."""
FIRST_SHOWN = 4
"""Photographs of the person; then it is shown anew with twice as many: an average sharpens by their ratio."""


class EarlyAverage:
    """Is told of photographs one by one, and writes `average.png` into the folder `out` where it has changed enough to be seen."""

    def __init__(
        self, out: Path, publish: Callable[[Path], None], distances: IdentityDistances, choice: Choice, synthetic: bool
    ) -> None:
        self._out, self._publish = out, publish
        self._distances, self._choice, self._synthetic = distances, choice, synthetic
        self._frame = texture_frame(canonical_face(), AVERAGE_SIZE)
        self._faces: list[PhotoFace] = []
        self._pictures: list[NDArray[np.uint8] | None] = []
        self._wanted = FIRST_SHOWN

    def add(self, rgb: NDArray[np.uint8], faces: Sequence[PhotoFace]) -> None:
        """The faces of a photograph (H, W, 3) uint8, the largest first: of a group, that is who the photograph was taken of."""
        self._faces += faces
        self._pictures += [self._aligned(rgb, face) if place == 0 else None for place, face in enumerate(faces)]
        if faces and sum(one is not None for one in self._pictures) >= self._wanted:
            self._show()

    def _aligned(self, rgb: NDArray[np.uint8], face: PhotoFace) -> NDArray[np.uint8]:
        laid = align_photos(self._frame, [face.mesh], lambda number: rgb)
        return bared(self._frame, laid).colours[0]

    def _show(self) -> None:
        """Leaves and tells of the average of the one person's faces that are of use, where there are enough by now."""
        try:
            whose = belonging(self._faces, self._distances)
        except InputError:  # nobody is there twice so far
            return
        reasons = reasons_against(self._faces, whose, self._choice)
        used = [one for one, reason in zip(self._pictures, reasons, strict=True) if one is not None and reason is None]
        if len(used) < self._wanted:
            return
        self._wanted = 2 * len(used)
        mean = np.mean(used, axis=0)
        mean[~self._frame.face] = BACKGROUND_COLOUR
        write_still(self._out / "average.png", np.rint(mean).astype(np.uint8), self._synthetic)
        self._publish(self._out / "average.png")
