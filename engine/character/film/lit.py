"""A picture of the characters under lamps: what light and shadow make of their surfaces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.export.lit_preview import LitPreview
from engine.geometry.camera import Camera
from engine.geometry.rigging.skinning import skin
from engine.motion.kinematics import pose_transforms
from engine.render.scene.character import Actor


def lit_picture(cast: Sequence[Actor], camera: Camera, plate: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The characters in the first frames of their clips, the later before the earlier, over `plate` (H, W, 3).

    Raises
    ------
    InputError : `gl_unavailable`, where there is no OpenGL without a screen.
    """
    picture = plate
    for actor in cast:
        mesh, clip = actor.subject.mesh, actor.clip
        transforms = pose_transforms(mesh.skeleton, clip.rotations[:1], clip.root[:1])[0]
        posed = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
        with LitPreview(mesh, camera.size) as preview:
            picture = preview.draw(posed + np.array(actor.place, np.float32), camera, picture).rgb
    return picture
