"""A network of the operator's that tells people apart: an ONNX file that takes one chip and gives one vector."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.imaging.resample import resized
from engine.perception.identity.descriptor import IdentityDistances
from engine.perception.identity.face_chip import ARCFACE_LAYOUT, face_chip
from engine.perception.models import DESCRIPTOR_SETTING, ModelError, ModelFile, open_model, three_numbers

Colour = tuple[float, float, float]


@dataclass(frozen=True)
class OperatorDescriptor:
    """A `FaceDescriptor`: input (1, 3, side, side) float32, normalised by `mean` and `std` of colours in [0, 1]; the first output's
    numbers, of unit length, are the descriptor."""

    file: ModelFile
    session: Any
    side: int
    mean: Colour
    std: Colour
    distances: IdentityDistances

    @classmethod
    def load(cls, file: ModelFile, settings: Mapping[str, str]) -> OperatorDescriptor:
        """The file, by the settings beside it: _SAME and _OTHER (both needed: what distances mean), _MEAN and _STD.

        Raises `ModelError`.
        """
        session = open_model(file)
        inputs = session.get_inputs()
        if len(inputs) != 1 or len(inputs[0].shape) != 4 or inputs[0].shape[1] != 3:
            raise ModelError(f"{file.path.name} does not take one picture of shape (1, 3, h, w)")
        side = inputs[0].shape[2]
        return cls(
            file,
            session,
            side if isinstance(side, int) else ARCFACE_LAYOUT.side,
            three_numbers(settings.get(f"{DESCRIPTOR_SETTING}_MEAN", "0.5")),
            three_numbers(settings.get(f"{DESCRIPTOR_SETTING}_STD", "0.5")),
            operator_distances(settings),
        )

    def __call__(self, rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
        chip = face_chip(rgb, mesh, ARCFACE_LAYOUT)
        if self.side != ARCFACE_LAYOUT.side:
            chip = resized(chip, (self.side, self.side))
        colours = (chip.astype(np.float32) / 255 - np.array(self.mean, np.float32)) / np.array(self.std, np.float32)
        tensor = np.ascontiguousarray(colours.transpose(2, 0, 1)[None], np.float32)
        output = np.asarray(self.session.run(None, {self.session.get_inputs()[0].name: tensor})[0], np.float32).ravel()
        length = float(np.linalg.norm(output))
        if not np.isfinite(length) or length == 0:
            raise ModelError(f"{self.file.path.name} gave no descriptor")
        return output / length


def operator_distances(settings: Mapping[str, str]) -> IdentityDistances:
    """What the settings beside the file say of its distances. Raises `ModelError`."""
    told = [settings.get(f"{DESCRIPTOR_SETTING}_{part}", "") for part in ("SAME", "OTHER")]
    try:
        same, other = (float(text) for text in told)
    except ValueError as error:
        raise ModelError(f"{DESCRIPTOR_SETTING} needs _SAME and _OTHER beside it, distances of descriptors") from error
    return IdentityDistances(same, other)
