"""Models that the operator brings: ONNX files named in the settings, off unless they are.

The project ships none. The operator says where the file lies, what it must hash to and under which licence
it is used; the licence is repeated where the service lists what it runs on. Today one role is open to such
a model: matting, instead of the networks that come with the project.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

MATTING_SETTING = "GALATEA_MATTING_MODEL"
"""The file; the same with _SHA256 and _LICENCE (both needed), and _SIZE ("512"), _MEAN and _STD ("0.5" or
three numbers with commas, of colours in [0, 1]) where the model needs them."""


class ModelError(Exception):
    """A model of the operator's cannot be used; the message says why."""


@dataclass(frozen=True)
class ModelFile:
    """An ONNX file, the SHA-256 it must have (hex) and the licence it is used under."""

    path: Path
    sha256: str
    licence: str


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
    path = settings.get(MATTING_SETTING, "")
    if not path:
        return None
    sha256, licence = (settings.get(f"{MATTING_SETTING}_{part}", "") for part in ("SHA256", "LICENCE"))
    if not sha256 or not licence:
        raise ModelError(f"{MATTING_SETTING} needs {MATTING_SETTING}_SHA256 and {MATTING_SETTING}_LICENCE beside it")
    return load_matting_model(
        ModelFile(Path(path), sha256, licence),
        int(settings.get(f"{MATTING_SETTING}_SIZE", "512")),
        _three(settings.get(f"{MATTING_SETTING}_MEAN", "0")),
        _three(settings.get(f"{MATTING_SETTING}_STD", "1")),
    )


def load_matting_model(
    file: ModelFile,
    size: int = 512,
    mean: tuple[float, float, float] = (0.0, 0.0, 0.0),
    std: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> MattingModel:
    """Check the file's hash and open it. Raises `ModelError`."""
    session = _open(file)
    inputs = session.get_inputs()
    shape = inputs[0].shape
    if len(inputs) != 1 or len(shape) != 4 or shape[1] != 3:
        raise ModelError(f"{file.path.name} does not take one picture of shape (1, 3, h, w)")
    height, width = (side if isinstance(side, int) else size for side in shape[2:])
    return MattingModel(file, session, (width, height), mean, std)


def _open(file: ModelFile) -> Any:
    try:
        content = file.path.read_bytes()
    except OSError as error:
        raise ModelError(f"{file.path} cannot be read: {error.strerror}") from error
    found = hashlib.sha256(content).hexdigest()
    if found != file.sha256.lower():
        raise ModelError(f"{file.path.name} has SHA-256 {found}, the settings say {file.sha256}")
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.log_severity_level = 3
    try:
        return onnxruntime.InferenceSession(content, options, providers=["CPUExecutionProvider"])
    except Exception as error:  # the runtime's own errors have no common public base
        raise ModelError(f"{file.path.name} is no model that can be run: {error}") from error


def _three(text: str) -> tuple[float, float, float]:
    values = [float(part) for part in text.split(",")]
    if len(values) == 1:
        values *= 3
    if len(values) != 3:
        raise ModelError(f"expected one or three numbers, got {text!r}")
    return values[0], values[1], values[2]
