"""The template itself as an avatar, as if it had been fitted to somebody: whole files without any film."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from engine.avatar.acting import Scene
from engine.avatar.avatar import Avatar, assemble
from engine.avatar.options import MAX_TEMPLATE_TRIANGLES, AvatarOptions
from engine.avatar.registration.eyes.fitted_eyes import IRIS_RADIUS_METRES
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.texture.template_surface import template_surface
from engine.avatar.texture.template_texture.placing import place_eyes, place_mouth
from engine.avatar.worn import no_attachments
from engine.avatar.writing import write_avatar
from engine.body.face.visemes import viseme_displacements
from engine.body.rest_pose import t_pose
from engine.body.rig import HUMAN_RIG
from engine.body.template import FACE_UNITS, load_rig, load_template
from engine.motion.library import built_in
from engine.render.textures.texture_bake import texel_raster
from engine.run import Run

SKIN = (198, 156, 132)
"""Of the whole body, sRGB."""


def fitted_template() -> FittedTemplate:
    """The template, as if it had been fitted to somebody who stood in T-pose."""
    template, rig = load_template(), load_rig(HUMAN_RIG)
    skeleton, _, rest = t_pose(rig, template.vertices, template.vertices_of("body"))
    units = {unit: template.face_units.displacement({unit: 1.0}) for unit in FACE_UNITS}
    return FittedTemplate(
        vertices=rest.astype(np.float64),
        rest=rest,
        skeleton=skeleton,
        joints=skeleton.heads.astype(np.float64),
        rotations=np.tile(np.eye(3), (len(rig.names), 1, 1)),
        expressions=units | viseme_displacements(units, len(rest)),
        iris=IRIS_RADIUS_METRES,
        head_to_body=None,
        coefficients=np.zeros(3),
        notices=(),
    )


def template_avatar(texture_size: int = 256) -> Avatar:
    """It, with plain skin, painted eyes and a painted mouth."""
    template, rig = load_template(), load_rig(HUMAN_RIG)
    surface = template_surface(template, rig)
    texture = np.full((texture_size, texture_size, 3), SKIN, np.uint8)
    raster = texel_raster(surface.atlas, texture_size)
    place_mouth(texture, surface, raster)
    place_eyes(texture, surface, template.vertices, [], np.ones((0, 3)), IRIS_RADIUS_METRES, raster)
    return assemble(template, rig, fitted_template(), no_attachments(), texture, MAX_TEMPLATE_TRIANGLES)


def write_template_avatar(out: Path, options: AvatarOptions) -> None:
    """All files of an avatar that waves."""
    avatar = template_avatar()
    with Run() as run:
        write_avatar(out, avatar, Scene(built_in("wave", avatar.mesh.skeleton)), options, run)
