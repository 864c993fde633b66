"""dlib's residual network of faces: 128 numbers of a chip of 150x150.

Source: D. E. King, dlib, `dnn_face_recognition_ex.cpp` (2017): after K. He et al., Deep Residual Learning (CVPR 2016), trained so that
faces of one person are nearer than 0.6.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.package_data import IncompleteInstallation, package_data
from engine.perception.identity.descriptor import IdentityDistances
from engine.perception.identity.face_chip import DLIB_LAYOUT, face_chip

MODEL_FILE = "dlib_face_recognition_resnet_model_v1.dat"
MODEL_SHA256 = "55533b28a95800a551ba546ba62fe69625c7e95a7061c338adffead08719da30"

IDENTITY_DISTANCES = IdentityDistances(same=0.6, other=0.7)
"""Distances of descriptors, of its author's training and as seen in collections of photographs: nearly all pairs of two
people have more than 0.63."""


@dataclass(frozen=True)
class DlibDescriptor:
    """A `FaceDescriptor`."""

    network: Any
    distances: IdentityDistances = IDENTITY_DISTANCES

    @classmethod
    def load(cls) -> DlibDescriptor:
        """With the network that set-up has put there. Raises `IncompleteInstallation`."""
        return cls(loaded_network())

    def __call__(self, rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
        chip = face_chip(rgb, mesh, DLIB_LAYOUT)
        return np.array(self.network.compute_face_descriptor(np.ascontiguousarray(chip)), np.float32)


@cache
def loaded_network() -> Any:
    """The network itself, read once. Raises `IncompleteInstallation`."""
    import dlib

    path = package_data("engine.perception.identity", MODEL_FILE)
    if hashlib.sha256(path.read_bytes()).hexdigest() != MODEL_SHA256:
        raise IncompleteInstallation(
            "installation_incomplete",
            f"{path} is not the file that it should be: remove it and run `make setup` again.",
        )
    return dlib.face_recognition_model_v1(str(path))
