"""The character of two surfaces: trunk, head and cloth that hangs are the picture's relief, arms and legs the displaced template.

Beyond the paper, in which every part is cut out of the picture and given its depth. That is the sharper where the picture shows a
surface whole, and fails where parts touch or hide one another, as legs that pass; the template is whole there, and has neither
hair nor clothes. So each is what it is good at, and limbs reach into the trunk: no place is left at which anything could gape.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.hair.volume import hair_volume
from engine.character.hybrid.cut_off import cut_off
from engine.character.hybrid.head import (
    hair_beside_the_head,
    head_is_known,
    joined_at_the_neck,
    with_hair_apart,
    with_head,
    without_head,
)
from engine.character.hybrid.limbs import Limbs, joined_in_depth, limbs_of
from engine.character.hybrid.neck_cloth import with_neck_cloth
from engine.character.hybrid.outline_warp import drawn_to_the_outline
from engine.character.hybrid.trunk import soft_beside_limbs, trunk_labels, trunk_layer
from engine.character.hybrid.under_cloth import going_with_the_cloth
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, TRUNK_LABEL
from engine.character.parts.strange_colours import strange_colours
from engine.character.shell.piece import Piece
from engine.character.shell.props import props_of
from engine.character.shell.shell import (
    Shell,
    as_fitted,
    face_points,
    posed,
    shaped,
    shell_of,
    with_head_at_face,
)
from engine.character.shell.template_mesh import template_mesh
from engine.character.surface.face_warp import seen_face
from engine.character.surface.front_and_back import ClosedMesh, stitch_front_and_back
from engine.render.rasterisation.rasteriser import rasterise

SHOULDER_NEARNESS = 0.3
"""How near to a shoulder, from 0 to 1 there, the arm and the trunk are one surface."""


@dataclass(frozen=True)
class Hybrid:
    """Both surfaces in the pictured pose.

    shell : the whole shell, its limbs where they are to the trunk.
    limbs : which of it is shown.
    trunk : the relief.
    labels : what each pixel shows of the body, as the trunk is made of them.
    strange : (h, w) bool, pixels that have not the colours of what they are labelled as.
    hair : (h, w) bool, what of the trunk's pixels shows hair that falls over it.
    framed : (V,) float32, what of the shell's head ends at a surface of hair, from 0 to 1; none where there is none.
    """

    shell: Shell
    limbs: Limbs
    trunk: ClosedMesh
    labels: Labels
    strange: NDArray[np.bool_]
    hair: NDArray[np.bool_]
    framed: NDArray[np.float32] | None = None

    def at_shoulders(self) -> NDArray[np.bool_]:
        """The pixels (h, w) of the grid at which shoulders are, whose surface is the arm's and the trunk's alike."""
        mesh = self.shell.mesh
        shoulder = (self.limbs.near > SHOULDER_NEARNESS) & np.isin(self.limbs.limb, ARM_LABELS)
        joint = shoulder[mesh.triangles].all(1)
        height, width = self.labels.labels.shape
        return np.asarray(
            rasterise(self.shell.pictured * [1, 1, -1], mesh.triangles[joint], (height, width)).triangle >= 0
        )

    def before_the_body(self, labels: Labels) -> NDArray[np.bool_]:
        """The pixels (h, w) of the grid at which hair, or what is held, lies before trunk and limbs, and the picture shows nothing of these. `labels`:
        as they were before hair was told apart."""
        if self.labels.held is None:
            return self.hair
        return np.asarray(self.hair | ((self.labels.held >= 0) & (labels.labels != HEAD_LABEL)))


def make_hybrid(figure: Figure, silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> Hybrid:
    """Both surfaces of a person: `figure` and `silhouette` as they were found, the `fitted` template, and the `labels` of its parts. A head that is
    not known to be where the template's is remains the relief's."""
    mesh, human = template_mesh(), load_human()
    camera = silhouette.camera(fitted.picture_camera())
    labels = with_neck_cloth(figure, silhouette, labels.bare)
    placed = with_head_at_face(mesh, as_fitted(silhouette, fitted)[1], face_points(figure, silhouette, mesh))
    head = (figure, silhouette, labels, mesh, placed)
    with_its_head = head_is_known(*head)
    if with_its_head:
        labels = with_hair_apart(*head)
    own = trunk_labels(labels)
    strange = strange_colours(silhouette.rgb, own.labels)
    fallen = hair_beside_the_head(*head) & (own.labels == TRUNK_LABEL)
    body = pose_template(fitted, camera, human)
    shape = shaped(figure, silhouette, fitted, labels)
    seen = own
    if with_its_head:
        own = without_head(own)
    face = None if with_its_head else seen_face(figure, silhouette, body, human.face, own)
    layer = trunk_layer(own, body, human.rig, face)
    places = (shape.pictured[:, :2] - silhouette.to_grid[:, 2]) / np.diag(silhouette.to_grid)
    height, width = silhouette.alpha.shape
    within = np.asarray(((places > -1) & (places < [width, height])).all(1), np.bool_)
    limbs = limbs_of(mesh, shape.pictured, own, fitted, within)
    pictured, layer = joined_in_depth(mesh, shape.pictured, limbs, layer, own)
    trunk = stitch_front_and_back([layer], silhouette.soft, {layer.limb: soft_beside_limbs(layer, own)})
    if with_its_head:
        limbs = with_head(limbs, mesh, fitted)
        pictured, trunk = joined_at_the_neck(mesh, pictured, limbs, trunk, seen)
    shown = cut_off(mesh, limbs).triangles
    pictured = drawn_to_the_outline(pictured, limbs, shown, trunk, silhouette.soft, own.held)
    covering = Piece("trunk", trunk.vertices, trunk.triangles, trunk.bones.astype(np.intp), trunk.weights)
    pieces, framed = props_of(mesh, pictured, silhouette, [covering], own.held), None
    if own.held is not None and (own.held == HEAD_LABEL).any():
        front, back = _depths(pictured, shown, trunk, (own.labels.shape[0], own.labels.shape[1]))
        front = np.where(silhouette.mask, front, -np.inf).astype(np.float32)
        hair = hair_volume(mesh, pictured, figure.rgb, silhouette.to_grid, own.held == HEAD_LABEL, front, back)
        if hair is not None:
            pieces.append(hair.hair)
            pictured, framed = hair.pictured, hair.framed
    held = going_with_the_cloth(mesh, pictured, limbs, layer, own)
    moved = camera.to_picture(posed(held, shape.straight, fitted))
    template = np.where((held.weights != mesh.weights).any(1)[:, None], moved, shape.template)
    shell = shell_of(held, replace(shape, template=template, pictured=pictured), silhouette, fitted, pieces)
    return Hybrid(shell, limbs, trunk, own, strange, fallen, framed)


def _depths(
    places: NDArray[np.float64], triangles: NDArray[np.int32], trunk: ClosedMesh, shape: tuple[int, int]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """How near and how far (h, w) what is shown reaches, infinite where nothing is."""
    both = np.concatenate([places, trunk.vertices])
    faces = np.concatenate([triangles, trunk.triangles + len(places)])
    found = []
    for towards in (1.0, -1.0):
        raster = rasterise(both * [1, 1, -towards], faces, shape)
        found.append(np.where(raster.triangle >= 0, -towards * raster.depth, -towards * np.inf).astype(np.float32))
    return found[0], found[1]


def limbs_alone(hybrid: Hybrid) -> Shell:
    """The shell without what the trunk is in place of."""
    return replace(hybrid.shell, mesh=cut_off(hybrid.shell.mesh, hybrid.limbs))
