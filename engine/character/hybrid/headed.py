"""The relief with the shell's head: the paper's surface for all that the picture shows of a person, and a whole head on it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody
from engine.character.hybrid.head import (
    hair_keeps_to_the_head,
    joined_at_the_neck,
    no_limbs,
    with_head,
    without_head,
)
from engine.character.hybrid.limbs import Limbs
from engine.character.parts.label_map import Labels
from engine.character.shell.shell import Shell, as_fitted, face_points, shaped_head, shell_of, with_head_at_face
from engine.character.shell.template_mesh import template_mesh
from engine.character.surface.front_and_back import ClosedMesh


@dataclass(frozen=True)
class HeadedRelief:
    """A relief that may have the head of a shell.

    relief : in the pictured pose.
    labels : of the parts that it is made of.
    shell : the one whose head it has.
    shown : which of the shell's vertices are that head; none where the relief has its own.
    """

    relief: ClosedMesh
    labels: Labels
    shell: Shell | None = None
    shown: Limbs | None = None


def make_headed_relief(
    figure: Figure,
    silhouette: Silhouette,
    fitted: FittedBody,
    labels: Labels,
    build: Callable[[Figure, Silhouette, FittedBody, Labels], ClosedMesh],
) -> HeadedRelief:
    """The relief, as `build` makes it of a figure, with the shell's head if that is its shape."""
    mesh = template_mesh()
    placed = with_head_at_face(mesh, as_fitted(silhouette, fitted)[1], face_points(figure, silhouette, mesh))
    if not hair_keeps_to_the_head(figure, silhouette, labels, mesh, placed):
        return HeadedRelief(build(figure, silhouette, fitted, labels), labels)
    shape = shaped_head(figure, silhouette, fitted, labels)
    layered = labels.layered
    beheaded = without_head(layered)
    shown = with_head(no_limbs(mesh), mesh, fitted)
    relief = build(figure, silhouette, fitted, beheaded)
    pictured, relief = joined_at_the_neck(mesh, shape.pictured, shown, relief, layered)
    shell = shell_of(mesh, replace(shape, pictured=pictured), silhouette, fitted, [])
    return HeadedRelief(relief, beheaded, shell, shown)
