"""The shell: the fitted template displaced so that its outline in the picture is the person's.

Beyond the paper, which cuts the picture into a sheet for each part. There whatever touches or hides something must be cut
right; here every part is whole before the picture is looked at, and only its shape comes from the picture.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.parts.label_map import Labels
from engine.character.shell.template_mesh import TemplateMesh, template_mesh


@dataclass(frozen=True)
class Shell:
    """A surface in the pictured pose, and the same at rest.

    mesh : its triangles, chart and skinning weights.
    template : (V, 3) float64, the fitted template's vertices in the grid's picture space (x right, y down, pixels; z towards
        the viewer), not displaced.
    pictured : (V, 3) float64, where they come to lie there.
    rest : (V, 3) float64, where they are in T-pose, metres, y up.
    """

    mesh: TemplateMesh
    template: NDArray[np.float64]
    pictured: NDArray[np.float64]
    rest: NDArray[np.float64]


def make_shell(figure: Figure, silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> Shell:
    """The shell of a person: `figure` and `silhouette` as they were found, the `fitted` template, and the `labels` of its parts."""
    mesh = template_mesh()
    posed = pose_template(fitted, silhouette.camera(fitted.picture_camera()), load_human())
    template = posed.vertices[mesh.ids]
    return Shell(mesh, template, template, posed.rest[mesh.ids].astype(np.float64))
