"""A network of the operator's that says where a person is, instead of those that come with the project."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.perception.models import MATTING_SETTING, ModelError, ModelFile, named_model, open_model, three_numbers


@dataclass(frozen=True)
class MattingModel:
    """A network from colours to alpha: input (1, 3, h, w) float32, first output alpha with h x w values.

    `size` is the side it works at where its input's shape leaves that open; `mean` and `std` normalise
    colours in [0, 1].
    """

    file: ModelFile
    session: Any
    size: tuple[int, int]
    mean: tuple[float, float, float] = (0.0, 0.0, 0.0)
    std: tuple[float, float, float] = (1.0, 1.0, 1.0)

    def __call__(self, rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
        """Alpha (h, w) in [0, 1] of the people in `rgb` (H, W, 3) uint8, at the model's own size."""
        from engine.imaging.resample import resized  # not for those who only ask for the setting

        small = resized(np.ascontiguousarray(rgb), self.size).astype(np.float32) / np.float32(255)
        normal = (small - np.array(self.mean, np.float32)) / np.array(self.std, np.float32)
        tensor = np.ascontiguousarray(normal.transpose(2, 0, 1)[None], np.float32)
        output = np.asarray(self.session.run(None, {self.session.get_inputs()[0].name: tensor})[0], np.float32)
        width, height = self.size
        if output.size != width * height:
            raise ModelError(f"{self.file.path.name} gave an output of shape {output.shape}, not one alpha a pixel")
        return np.clip(output.reshape(height, width), 0, 1)


def matting_model(settings: Mapping[str, str]) -> MattingModel | None:
    """The matting model that `settings` (as a rule the environment) name; None if they name none.

    Raises `ModelError` if it is named but its hash or licence are not, or do not fit.
    """
    named = named_model(settings, MATTING_SETTING)
    if named is None:
        return None
    return load_matting_model(
        named,
        int(settings.get(f"{MATTING_SETTING}_SIZE", "512")),
        three_numbers(settings.get(f"{MATTING_SETTING}_MEAN", "0")),
        three_numbers(settings.get(f"{MATTING_SETTING}_STD", "1")),
    )


def load_matting_model(
    file: ModelFile,
    size: int = 512,
    mean: tuple[float, float, float] = (0.0, 0.0, 0.0),
    std: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> MattingModel:
    """Check the file's hash and open it. Raises `ModelError`."""
    session = open_model(file)
    inputs = session.get_inputs()
    shape = inputs[0].shape
    if len(inputs) != 1 or len(shape) != 4 or shape[1] != 3:
        raise ModelError(f"{file.path.name} does not take one picture of shape (1, 3, h, w)")
    height, width = (side if isinstance(side, int) else size for side in shape[2:])
    return MattingModel(file, session, (width, height), mean, std)
