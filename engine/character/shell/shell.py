"""The shell: the fitted template displaced so that its outline in the picture is the person's.

Beyond the paper, which cuts the picture into a sheet for each part. There whatever touches or hides something must be cut
right; here every part is whole before the picture is looked at, and only its shape comes from the picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.character.figure.face_region import in_profile
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import HEAD_LABEL
from engine.character.shell.at_rest import shell_at_rest
from engine.character.shell.displacement import KnownPoints, displace
from engine.character.shell.extremities import barefoot, in_shoes
from engine.character.shell.outlines import part_outlines
from engine.character.shell.piece import Piece
from engine.character.shell.props import props_of
from engine.character.shell.skirt import skirt_of
from engine.character.shell.template_mesh import MIN_SURE_HEAD_WEIGHT, TemplateMesh, template_mesh
from engine.character.shell.thickness import thickened
from engine.geometry.rigging.skinning import bone_transforms, skin
from engine.imaging.masks.mask_distance import distance_to
from engine.perception.face.landmarks import JAW_LANDMARK_COUNT, fiducials

HEAD_SIZES = (0.85, 1.25)
"""How large a head may be, as a share of the fitted template's."""
HEAD_MOVE_NECK_SHARE = 0.5
"""How far the neck goes with the head that is put to where its face is seen."""
HEAD_SURROUND_METRES = 0.12
"""Metres beyond the head's radius in which what is around gives way where it is displaced."""
EAR_TOLERANCE_PIXELS, MIN_EAR_SHARE = 0.5, 0.25
"""Pixels of the grid by which an ear may stand out of the outline, and share of its width aside that it keeps."""
LID_RADII = 1.35
"""Radii of an eye from its centre within which the skin is its lids'."""


@dataclass(frozen=True)
class Shell:
    """A surface in the pictured pose, and the same at rest.

    mesh : its triangles, chart and skinning weights.
    template : (V, 3) float64, the fitted template's vertices in the grid's picture space (x right, y down, pixels; z towards
        the viewer), not displaced.
    pictured : (V, 3) float64, where they come to lie there.
    rest : (V, 3) float64, where they are in T-pose, metres, y up.
    pieces : a skirt, and what is held or worn beside the body.
    shod : whether its feet are in shoes.
    """

    mesh: TemplateMesh
    template: NDArray[np.float64]
    pictured: NDArray[np.float64]
    rest: NDArray[np.float64]
    pieces: tuple[Piece, ...] = ()
    shod: bool = False


@dataclass(frozen=True)
class Shape:
    """What a shell is made of, (V, 3) each.

    straight : the template in T-pose, in its shoes if it wears any, metres.
    template : as the fit has it.
    pictured, shod : as in `Shell`.
    """

    straight: NDArray[np.float64]
    template: NDArray[np.float64]
    pictured: NDArray[np.float64]
    shod: bool = False


def make_shell(figure: Figure, silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> Shell:
    """The shell of a person: `figure` and `silhouette` as they were found, the `fitted` template, and the `labels` of its parts."""
    labels = labels.bare
    mesh, shape = template_mesh(), shaped(figure, silhouette, fitted, labels)
    skirt = skirt_of(mesh, shape.pictured, labels)
    pieces = [] if skirt is None else [skirt]
    pieces += props_of(mesh, shape.pictured, silhouette, pieces, labels.held)
    return shell_of(mesh, shape, silhouette, fitted, pieces)


def shaped(figure: Figure, silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> Shape:
    """The template in its shoes, displaced to the outlines."""
    mesh, camera = template_mesh(), silhouette.camera(fitted.picture_camera())
    straight, template = as_fitted(silhouette, fitted)
    shod = not barefoot(figure, silhouette, labels, template)
    if shod:
        straight = in_shoes(straight)
        template = camera.to_picture(posed(mesh, straight, fitted))
    known = face_points(figure, silhouette, mesh)
    start = with_head_at_face(mesh, template, known)
    displaced = displace(mesh, start, part_outlines(labels.layered), known)
    pictured = eyes_in_sockets(mesh, start, thickened(mesh, start, displaced))
    return Shape(straight, template, ears_laid_back(mesh, pictured, silhouette.mask), shod)


def as_fitted(silhouette: Silhouette, fitted: FittedBody) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The template's vertices (V, 3) in T-pose, barefoot, metres, and as the fit has them in the picture."""
    mesh, camera = template_mesh(), silhouette.camera(fitted.picture_camera())
    straight = load_human().space.vertices(fitted.fit.coefficients)[mesh.ids].astype(np.float64)
    return straight, camera.to_picture(posed(mesh, straight, fitted))


def shaped_head(figure: Figure, silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> Shape:
    """The shape of the head alone; what is far from it is as the fit has it."""
    mesh = template_mesh()
    straight, template = as_fitted(silhouette, fitted)
    places = load_human().space.mean[mesh.ids]
    head = mesh.head > MIN_SURE_HEAD_WEIGHT
    reach = HEAD_SURROUND_METRES + np.linalg.norm(places[head] - places[head].mean(0), axis=1).max()
    near = np.linalg.norm(places - places[head].mean(0), axis=1) < reach
    own, which = mesh.part(near)
    outlines = part_outlines(labels.layered).of(HEAD_LABEL)
    known = face_points(figure, silhouette, mesh)
    start = with_head_at_face(mesh, template, known)
    again = np.full(len(places), -1, np.intp)
    again[which] = np.arange(len(which))
    displaced = displace(own, start[which], outlines, replace(known, vertices=again[known.vertices]))
    pictured = template.copy()
    pictured[which] = thickened(own, start[which], displaced)
    return Shape(straight, template, ears_laid_back(mesh, eyes_in_sockets(mesh, start, pictured), silhouette.mask))


def with_head_at_face(mesh: TemplateMesh, template: NDArray[np.float64], known: KnownPoints) -> NDArray[np.float64]:
    """The `template` (V, 3) with its head as a whole moved and enlarged so that its face is where it is `known` to be seen, the neck
    less and less. Heads of one body's height differ by more than the fit of a body tells."""
    if not len(known.vertices):
        return template
    own = template[known.vertices]
    centre, seen = own.mean(0), known.places.mean(0)
    size = np.linalg.norm(known.places - seen) / max(float(np.linalg.norm(own[:, :2] - centre[:2])), 1e-6)
    moved = centre + np.clip(size, *HEAD_SIZES) * (template - centre)
    moved[:, :2] += seen - centre[:2]
    share = np.clip(mesh.share("Head") + HEAD_MOVE_NECK_SHARE * mesh.share("Neck"), 0, 1)[:, None]
    return np.asarray(template + share * (moved - template))


def ears_laid_back(mesh: TemplateMesh, pictured: NDArray[np.float64], mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The vertices `pictured` (V, 3) with each ear turned towards the head, about where it begins. It is turned as far
    as it stands out of the person's `mask` (h, w): hair lies over it, or it is closer to the head than the
    template's."""
    moved, beyond = pictured.copy(), distance_to(mask)
    ears = np.flatnonzero(mesh.ear)
    middle = np.median(pictured[(mesh.head > MIN_SURE_HEAD_WEIGHT) & ~mesh.ear, 0])
    for ear in (ears[pictured[ears, 0] < middle], ears[pictured[ears, 0] >= middle]):
        if not len(ear):
            continue
        column, row = np.clip(np.rint(pictured[ear, :2]), 0, [mask.shape[1] - 1, mask.shape[0] - 1]).astype(int).T
        stands_out = float(beyond[row, column].max()) - EAR_TOLERANCE_PIXELS
        aside = np.sign(pictured[ear, 0].mean() - middle)
        base = (aside * pictured[ear, 0]).min()
        wide = np.ptp(pictured[ear, 0])
        if stands_out > 0 and wide > 0:
            kept = max(1 - stands_out / wide, MIN_EAR_SHARE)
            moved[ear, 0] = aside * (base + kept * (aside * pictured[ear, 0] - base))
    return moved


def eyes_in_sockets(
    mesh: TemplateMesh, template: NDArray[np.float64], pictured: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The vertices `pictured` (V, 3) with each eye moved as a whole from where it was in the `template` (V, 3), as the lids around it are:
    nothing joins it to them."""
    moved, skin = pictured.copy(), np.flatnonzero((mesh.head > MIN_SURE_HEAD_WEIGHT) & ~mesh.eye)
    eyes = np.flatnonzero(mesh.eye)
    left = template[eyes, 0] < np.median(template[eyes, 0])
    for eye in (eyes[left], eyes[~left]):
        centre = template[eye].mean(0)
        radius = np.linalg.norm(template[eye] - centre, axis=1).max()
        lids = skin[np.linalg.norm(template[skin] - centre, axis=1) < LID_RADII * radius]
        if len(lids):
            moved[eye] = template[eye] + np.median(pictured[lids] - template[lids], 0)
    return moved


def shell_of(
    mesh: TemplateMesh, shape: Shape, silhouette: Silhouette, fitted: FittedBody, pieces: Sequence[Piece]
) -> Shell:
    """The shell of a shape, with what is beside it."""
    camera = silhouette.camera(fitted.picture_camera())
    rest = shell_at_rest(mesh, shape.straight, shape.template, shape.pictured, camera, fitted)
    return Shell(mesh, shape.template, shape.pictured, rest, tuple(pieces), shape.shod)


def posed(mesh: TemplateMesh, straight: NDArray[np.floating], fitted: FittedBody) -> NDArray[np.float32]:
    """The mesh in T-pose, `straight` (V, 3), as the fit has it in the picture: (V, 3) metres, the camera at the origin."""
    human, fit = load_human(), fitted.fit
    heads = human.space.joints(fit.coefficients)
    transforms = bone_transforms(human.rig.parents, heads, fit.rotations, fit.root_translation - heads[0])
    return skin(straight, mesh.bones, mesh.weights, transforms)


def face_points(figure: Figure, silhouette: Silhouette, mesh: TemplateMesh) -> KnownPoints:
    """The fiducials within the face, and where they are seen on the grid. There are none of a face that is not seen, or
    in profile: of that the network makes up one half."""
    if figure.face is None or in_profile(figure):
        return KnownPoints(np.zeros(0, np.intp), np.zeros((0, 2)))
    seen = fiducials(figure.face[:, :2])[JAW_LANDMARK_COUNT:].astype(np.float64)
    places = seen @ silhouette.to_grid[:, :2].T + silhouette.to_grid[:, 2]
    vertices = mesh.renamed(load_human().face[JAW_LANDMARK_COUNT:])
    there = vertices >= 0
    return KnownPoints(vertices[there], places[there])
