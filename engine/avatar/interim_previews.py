"""What is shown of an avatar on the way: the fitted shape, and its texture, small."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.avatar.mesh import AVATAR_PARTS
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.body.template import Template
from engine.export.ply import write_mesh_ply
from engine.export.still import write_still
from engine.geometry.mesh.surface import triangulate
from engine.imaging.resample import resized, size_within

TEXTURE_SIDE_PIXELS = 640
"""Pixels of the small texture."""


def write_fitted_shape(out: Path, template: Template, fitted: FittedTemplate) -> Path:
    """Write `fitted.ply`: the person's shape as it stands in the cloud, without a texture, metres; half a megabyte. Its path."""
    path = out / "fitted.ply"
    used, corners = np.unique(triangulate(template.quads[template.faces(*AVATAR_PARTS)]), return_inverse=True)
    write_mesh_ply(path, fitted.vertices[used], corners.reshape(-1, 3))
    return path


def write_small_texture(out: Path, texture: NDArray[np.uint8], synthetic: bool) -> Path:
    """Write `texture_preview.jpg`, a texture (S, S, 3) as it is looked at before the avatar is there. Its path."""
    path = out / "texture_preview.jpg"
    write_still(path, resized(texture, size_within(texture.shape, TEXTURE_SIDE_PIXELS)), synthetic)
    return path
