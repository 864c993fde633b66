"""Which backend tells people apart: the operator's, or dlib's."""

from __future__ import annotations

from collections.abc import Mapping

from engine.perception.identity.descriptor import FaceDescriptor, IdentityDistances
from engine.perception.identity.dlib_descriptor import IDENTITY_DISTANCES, MODEL_SHA256, DlibDescriptor
from engine.perception.identity.operator_descriptor import OperatorDescriptor, operator_distances
from engine.perception.models import DESCRIPTOR_SETTING, named_model


def face_descriptor(settings: Mapping[str, str]) -> FaceDescriptor:
    """The operator's own where `settings` (as a rule the environment) name one, else dlib's.

    Raises
    ------
    ModelError : the operator's model cannot be used.
    IncompleteInstallation : dlib's model file is not there, or is another.
    """
    named = named_model(settings, DESCRIPTOR_SETTING)
    if named is not None:
        return OperatorDescriptor.load(named, settings)
    return DlibDescriptor.load()


def descriptor_name(settings: Mapping[str, str]) -> str:
    """Which model describes faces: its SHA-256. Raises `ModelError` as `face_descriptor` does."""
    named = named_model(settings, DESCRIPTOR_SETTING)
    return named.sha256 if named is not None else MODEL_SHA256


def descriptor_distances(settings: Mapping[str, str]) -> IdentityDistances:
    """What distances of its descriptors mean; no network is loaded for it. Raises `ModelError` as `face_descriptor` does."""
    return operator_distances(settings) if named_model(settings, DESCRIPTOR_SETTING) is not None else IDENTITY_DISTANCES
