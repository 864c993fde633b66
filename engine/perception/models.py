"""Models that the operator brings: ONNX files named in the settings, off unless they are.

The operator says where the file lies, what it must hash to and under which licence it is used; the licence is repeated where the
service lists what it runs on. Two roles are open to such models: matting, and telling people apart, each instead of what comes
with the project.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

MATTING_SETTING = "GALATEA_MATTING_MODEL"
"""The file; the same with _SHA256 and _LICENCE (both needed), and _SIZE ("512"), _MEAN and _STD ("0.5" or
three numbers with commas, of colours in [0, 1]) where the model needs them."""
DESCRIPTOR_SETTING = "GALATEA_FACE_DESCRIPTOR_MODEL"
"""The file; the same with _SHA256, _LICENCE, _SAME and _OTHER (all needed), _MEAN and _STD."""
MODEL_SETTINGS = (MATTING_SETTING, DESCRIPTOR_SETTING)


class ModelError(Exception):
    """A model of the operator's cannot be used; the message says why."""


@dataclass(frozen=True)
class ModelFile:
    """An ONNX file, the SHA-256 it must have (hex) and the licence it is used under."""

    path: Path
    sha256: str
    licence: str


def named_model(settings: Mapping[str, str], setting: str) -> ModelFile | None:
    """The model that `settings` (as a rule the environment) name by `setting`; None if they name none.

    Raises `ModelError` if it is named but its hash or licence are not.
    """
    path = settings.get(setting, "")
    if not path:
        return None
    sha256, licence = (settings.get(f"{setting}_{part}", "") for part in ("SHA256", "LICENCE"))
    if not sha256 or not licence:
        raise ModelError(f"{setting} needs {setting}_SHA256 and {setting}_LICENCE beside it")
    return ModelFile(Path(path), sha256, licence)


def open_model(file: ModelFile) -> Any:
    """An inference session of the file, on the processor. Raises `ModelError` where its hash is another, or it is no model."""
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


def three_numbers(text: str) -> tuple[float, float, float]:
    """Three numbers with commas between them, or one for all three. Raises `ModelError`."""
    values = [float(part) for part in text.split(",")]
    if len(values) == 1:
        values *= 3
    if len(values) != 3:
        raise ModelError(f"expected one or three numbers, got {text!r}")
    return values[0], values[1], values[2]
