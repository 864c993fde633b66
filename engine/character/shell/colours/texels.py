"""What of the template each texel of its chart shows."""

from __future__ import annotations

from functools import cache

import numpy as np

from engine.character.shell.template_mesh import template_mesh
from engine.render.rasterisation.rasteriser import Raster, rasterise

SHELL_TEXTURE_SIZE_TEXELS = 2048
"""Texels of the texture's sides."""


@cache
def texels() -> Raster:
    """What of the template each texel shows, (`SHELL_TEXTURE_SIZE_TEXELS`, `SHELL_TEXTURE_SIZE_TEXELS`), once for the process;
    texels beside its chart show nothing."""
    mesh = template_mesh()
    flat = np.zeros((len(mesh.uv), 3), np.float32)
    flat[:, :2] = mesh.uv * SHELL_TEXTURE_SIZE_TEXELS - 0.5
    return rasterise(flat, mesh.uv_triangles, (SHELL_TEXTURE_SIZE_TEXELS, SHELL_TEXTURE_SIZE_TEXELS))
