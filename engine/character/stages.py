"""The stages of a character from silhouette to skeleton, each from what was found to what is found next."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.drawing.flat_character import bind_drawing, label_drawing
from engine.character.drawing.flat_pose import fit_drawing
from engine.character.figure.crossed_arms import without_hidden_hand
from engine.character.figure.doubts import doubt_labels, require_labels
from engine.character.figure.face_region import face_ellipse, face_turn, in_profile, within_oval
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import OPAQUE_ALPHA, Silhouette
from engine.character.figure.strokes import read_labels, relabel
from engine.character.fit.hands import turn_hands
from engine.character.fit.head import turn_head
from engine.character.fit.repeated_detection import detect_again
from engine.character.fit.template_fit import FittedBody, fit_best, load_human, pose_template
from engine.character.hybrid.behind_limbs import mirrored_behind
from engine.character.hybrid.cut_off import cut_off
from engine.character.hybrid.headed import HeadedRelief, make_headed_relief
from engine.character.hybrid.hybrid import Hybrid, limbs_alone
from engine.character.hybrid.joined_characters import joined
from engine.character.hybrid.seam import with_the_trunks_colours
from engine.character.hybrid.under_cloth import bare_under_cloth
from engine.character.options import LabelStroke
from engine.character.parts.crossed_labels import label_crossed
from engine.character.parts.hem import with_cloth
from engine.character.parts.label_map import LabelHints, Labels, label_parts
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, TRUNK_LABEL
from engine.character.parts.limb_edges import border
from engine.character.parts.unfound_hands import unfound_hands
from engine.character.rig.fewer_triangles import fewer_triangles
from engine.character.rig.measures import picture_camera
from engine.character.rig.relaxing import relaxed
from engine.character.rig.rigging import Character, bind
from engine.character.rig.shell_binding import bind_shell
from engine.character.rig.turned_over import without_backs_in_view
from engine.character.shell.colours.bare_skin import bare_skin
from engine.character.shell.colours.paint import paint_shell
from engine.character.shell.extremities import nose_colours
from engine.character.shell.shell import Shell
from engine.character.surface.face_warp import seen_face
from engine.character.surface.front_and_back import ClosedMesh, stitch_front_and_back
from engine.character.surface.layers import build_layers
from engine.character.texture.limb_texture import LimbSurfaces
from engine.character.texture.rings import limb_heights
from engine.character.texture.round_sides import with_round_sides
from engine.character.texture.texture import BackTexture, PictureOnGrid, Tiles, atlas, paint_tiles
from engine.imaging.masks.mask_distance import dilate_mask
from engine.media.limits import Limits

FACE_OVAL_FACTORS = np.array([1, 1, 1.1, 1.1, 1])
"""How much larger than its oval a face may be."""
MAX_EDGE_SCALE = 3.0
"""Pixels of a limb's edge for each of the grid's, at most."""
MOVING_ARM_JOINT_NAMES, MIN_ARM_WEIGHT = ("Arm", "Hand"), 0.05
"""What is in the names of joints of arms, and the share in what moves the body from which on it is moved by them."""
MIN_MOVED_BY_HAND_WEIGHT = 0.3
"""Share in what moves an arm from which on it is moved by the hand."""
MIXED_BORDER_PIXELS = 2
"""Pixels of the trunk beside a limb in which colours of both are mixed."""
TRUNK_MARGIN_PIXELS = 6
"""Pixels around the trunk within which it is painted behind limbs."""


def label(
    figure: Figure,
    silhouette: Silhouette,
    fitted: FittedBody,
    file: Path | None,
    strokes: tuple[LabelStroke, ...],
    limits: Limits,
    warn: Callable[[str, str], None],
) -> Labels:
    """The body label map (section 4.2.1). `file` is a label map that takes the place of what is found, and `strokes` are
    painted over it.

    Raises
    ------
    InputError : `labels_unreadable`, and what `read_labels` may raise. Warns of `labels_unlike_joints`.
    """
    human = load_human()
    posed = pose_template(fitted, silhouette.camera(fitted.picture_camera()), human)
    given = None if file is None else given_labels(file, figure, silhouette, limits)
    hints = LabelHints(
        given,
        hand_labels(without_hidden_hand(figure, fitted.crossed).hands, silhouette.to_grid, silhouette.mask.shape),
        unfound_hands(figure, silhouette.rgb, silhouette.to_grid),
        None
        if fitted.crossed is None
        else label_crossed(figure, fitted.crossed, posed, human.rig, silhouette.to_grid, silhouette.mask),
    )
    labels = label_parts(
        *(silhouette.rgb, silhouette.mask, posed, human.rig, hints),
        lambda found: _repainted(found, strokes, figure, silhouette),
    )
    if given is not None:
        doubt_labels(figure, labels.labels, silhouette.to_grid, warn)
    return with_cloth(labels, silhouette.rgb, posed, human.rig)


def given_labels(file: Path, figure: Figure, silhouette: Silhouette, limits: Limits) -> NDArray[np.int8]:
    """A label map from a picture, on the grid (h, w).

    Raises
    ------
    InputError : `labels_unreadable`, and what `read_labels` may raise.
    """
    height, width = figure.rgb.shape[:2]
    read = read_labels(file, [figure.original, (width, height)], limits)
    read = np.asarray(cv2.resize(read, (width, height), interpolation=cv2.INTER_NEAREST_EXACT), np.int8)
    size = (silhouette.mask.shape[1], silhouette.mask.shape[0])
    given = np.asarray(cv2.warpAffine(read.astype(np.int16), silhouette.to_grid, size, flags=cv2.INTER_NEAREST,
                                      borderValue=(-1,)), np.int8)  # fmt: skip
    require_labels(given, silhouette.mask)
    return given


def _repainted(
    labels: NDArray[np.int8], strokes: tuple[LabelStroke, ...], figure: Figure, silhouette: Silhouette
) -> NDArray[np.int8]:
    height, width = figure.rgb.shape[:2]
    return relabel(labels, strokes, figure.scale, silhouette.to_grid, (height, width))


def label_drawn(
    figure: Figure, silhouette: Silhouette, file: Path | None, strokes: tuple[LabelStroke, ...], limits: Limits
) -> Labels:
    """The label map of a drawing, as `label` has it of a person.

    Raises
    ------
    InputError : what `given_labels` may raise.
    """
    given = None if file is None else given_labels(file, figure, silhouette, limits)
    labels = label_drawing(figure, silhouette, given)
    return replace(labels, labels=_repainted(labels.labels, strokes, figure, silhouette))


def fit_drawn(figure: Figure, silhouette: Silhouette) -> FittedBody:
    """The pose of a drawing, and the camera."""
    return fit_drawing(figure, silhouette.alpha > 0.5)


def make_drawn(
    figure: Figure, silhouette: Silhouette, fitted: FittedBody, mesh: ClosedMesh, triangles: int
) -> Character:
    """A drawing's mesh bound in T-pose and brought down to a number of triangles."""
    character = bind_drawing(figure, silhouette, fitted, mesh)
    return replace(character, mesh=fewer_triangles(character, triangles))


def hand_labels(
    hands: Sequence[NDArray[np.float32] | None], to_grid: NDArray[np.float64], shape: tuple[int, ...]
) -> NDArray[np.int8]:
    """Labels (h, w) of the grid where the left and the right hand, (21, 3) each, are seen, -1 elsewhere: before a thigh the
    template's hand is easily missed."""
    labels = np.full((shape[0], shape[1]), -1, np.int8)
    for arm, hand in zip(("left_arm", "right_arm"), hands, strict=True):
        if hand is not None:
            hull = cv2.convexHull(hand[:, :2] @ to_grid[:, :2].T.astype(np.float32) + to_grid[:, 2].astype(np.float32))
            painted = cv2.fillConvexPoly(np.zeros(labels.shape, np.uint8), np.rint(hull).astype(np.int32), (1,))
            labels[painted > 0] = BODY_PARTS.index(arm)
    return labels


def fit_template(figure: Figure, silhouette: Silhouette) -> FittedBody:
    """The template fitted to figure and silhouette, its head to the face (sections 3 and 5), its hands to the hands."""
    looks = detect_again(figure, silhouette.alpha)
    fitted = turn_head(fit_best(looks, silhouette.alpha > 0.5), figure)
    return turn_hands(fitted, without_hidden_hand(figure, fitted.crossed))


def build_mesh(figure: Figure, silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> ClosedMesh:
    """The mesh in the pictured pose (sections 4.1 and 4.2)."""
    labels = labels.layered
    human = load_human()
    posed = pose_template(fitted, silhouette.camera(fitted.picture_camera()), human)
    face = seen_face(figure, silhouette, posed, human.face, labels)
    return stitch_front_and_back(
        build_layers(labels, posed, human.rig, face), silhouette.soft, limb_borders(figure, silhouette, labels)
    )


def limb_borders(figure: Figure, silhouette: Silhouette, labels: Labels) -> dict[int, NDArray[np.float32]]:
    """For each of the limbs that are apart, what `border` says of it (h, w), by the picture's own pixels."""
    height, width = labels.labels.shape
    finer = min(MAX_EDGE_SCALE, max(1.0, 1 / float(silhouette.to_grid[0, 0])))
    size = (round(width * finer), round(height * finer))
    matrix = silhouette.to_grid * finer
    matrix[:, 2] += (finer - 1) / 2
    flags = cv2.INTER_AREA if matrix[0, 0] < 1 else cv2.INTER_LINEAR
    rgb = np.asarray(cv2.warpAffine(figure.rgb, matrix, size, flags=flags, borderMode=cv2.BORDER_REPLICATE), np.uint8)
    return {int(limb): border(labels.labels == limb, labels.labels >= 0, rgb) for limb in labels.apart}


def make_character(
    figure: Figure,
    silhouette: Silhouette,
    fitted: FittedBody,
    labels: Labels,
    mesh: ClosedMesh,
    triangles: int,
    back: BackTexture,
) -> Character:
    """The mesh textured, bound in T-pose and brought down to a number of triangles (section 5)."""
    labels = labels.layered
    reach = mesh.pixels(np.flatnonzero(mesh.layer > 0), labels.labels.shape)
    shown = mesh.seen_layer((labels.labels.shape[0], labels.labels.shape[1])) > 0
    along = _along_with_arms(mesh, labels)
    body = mesh.pixels(np.flatnonzero(mesh.layer == 0), labels.labels.shape)
    whole = {int(limb): mesh.pixels(np.flatnonzero(mesh.limb == limb), labels.labels.shape) for limb in labels.apart}
    human = load_human()
    posed = pose_template(fitted, silhouette.camera(fitted.picture_camera()), human)
    sleeves = {arm: _sleeve(mesh, arm, labels) for arm in ARM_LABELS if arm in labels.apart}
    tiles = _painted(
        figure,
        silhouette,
        labels,
        LimbSurfaces(reach, shown, along, body, sleeves, whole, limb_heights(posed, human.rig, labels.labels)),
        back,
    )
    return _made_of(figure, silhouette, fitted, labels, mesh, tiles, triangles)


def _painted(figure: Figure, silhouette: Silhouette, labels: Labels, limbs: LimbSurfaces, back: BackTexture) -> Tiles:
    face = face_ellipse(figure, silhouette.to_grid, labels.labels == BODY_PARTS.index("head"))
    turned = None if in_profile(figure) else face_turn(figure)
    picture = PictureOnGrid(figure.rgb, silhouette.alpha, silhouette.to_grid)
    return paint_tiles(picture, labels, limbs, face, back, turned)


def _made_of(
    figure: Figure,
    silhouette: Silhouette,
    fitted: FittedBody,
    labels: Labels,
    mesh: ClosedMesh,
    tiles: Tiles,
    triangles: int,
) -> Character:
    head = labels.labels == BODY_PARTS.index("head")
    face = face_ellipse(figure, silhouette.to_grid, head)
    round_it, cheek = labels.labels >= 0, np.zeros_like(head)
    if face is None or in_profile(figure):
        round_it &= ~head
    else:  # where a turned face ends at the outline, a cheek goes on beyond it
        cheek = within_oval(face * FACE_OVAL_FACTORS, head.shape)
    upright = np.isin(labels.labels, (BODY_PARTS.index("torso"), *LEG_LABELS))
    mesh = with_round_sides(mesh, round_it, cheek, 0, upright)
    texture, uv = atlas(tiles, mesh, 0)
    camera = silhouette.camera(fitted.picture_camera())
    inside = cv2.erode(silhouette.mask.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    character = bind(mesh, inside, camera, fitted, load_human().space, texture, uv)
    character = relaxed(replace(character, mesh=fewer_triangles(character, triangles)))
    height, width = figure.rgb.shape[:2]
    return without_backs_in_view(character, picture_camera(character, fitted, (height, width)))


def make_headed(figure: Figure, silhouette: Silhouette, fitted: FittedBody, labels: Labels) -> HeadedRelief:
    """The relief in the pictured pose, its head the shell's where that is its shape."""
    return make_headed_relief(figure, silhouette, fitted, labels, build_mesh)


def make_headed_character(
    figure: Figure,
    silhouette: Silhouette,
    fitted: FittedBody,
    labels: Labels,
    headed: HeadedRelief,
    triangles: int,
    back: BackTexture,
) -> Character:
    """Relief and head painted, bound in T-pose, put together and brought down to a number of triangles."""
    found = (figure, silhouette, fitted)
    if headed.shell is None or headed.shown is None:
        return make_character(*found, headed.labels, headed.relief, triangles, back)
    alone = replace(headed.shell, mesh=cut_off(headed.shell.mesh, headed.shown))
    beside = _left_for_a_relief(triangles, alone)
    character = make_character(*found, headed.labels, headed.relief, beside, back)
    texture = paint_shell(figure.rgb, silhouette, labels, headed.shell, back, alone.mesh.triangles)
    character = joined(bind_shell(alone, figure, silhouette, fitted, texture), character)
    return replace(character, mesh=fewer_triangles(character, triangles))


def _left_for_a_relief(triangles: int, beside: Shell) -> int:
    """How many of so many triangles a relief may have beside a part of a shell, which is brought down with it only where it has most of
    them: an even template loses more by that than a grid."""
    return max(triangles - len(beside.mesh.triangles), triangles // 2)


def make_shell_character(
    figure: Figure,
    silhouette: Silhouette,
    fitted: FittedBody,
    labels: Labels,
    shell: Shell,
    triangles: int,
    back: BackTexture,
) -> Character:
    """The shell painted, bound in T-pose and brought down to a number of triangles."""
    texture = paint_shell(figure.rgb, silhouette, labels.bare, shell, back)
    character = bind_shell(shell, figure, silhouette, fitted, texture)
    return replace(character, mesh=fewer_triangles(character, triangles))


def make_hybrid_character(
    figure: Figure,
    silhouette: Silhouette,
    fitted: FittedBody,
    labels: Labels,
    hybrid: Hybrid,
    triangles: int,
    back: BackTexture,
) -> Character:
    """Both surfaces painted, bound in T-pose, put together and brought down to a number of triangles."""
    own, trunk = hybrid.labels, hybrid.trunk
    held = np.zeros(own.labels.shape, np.bool_) if own.held is None else own.held >= 0
    limbs = np.isin(own.labels, own.apart) | held
    covered = trunk.pixels(np.arange(len(trunk.vertices)), limbs.shape)
    around = dilate_mask(covered, TRUNK_MARGIN_PIXELS)
    below = np.isin(own.labels, LEG_LABELS) & dilate_mask(own.labels == TRUNK_LABEL, TRUNK_MARGIN_PIXELS)
    below &= own.cloth is None or not own.cloth.hangs  # at the waist nothing is behind legs, at a hem cloth is
    hidden = limbs & around & ~below & ~hybrid.at_shoulders()
    hidden |= (own.labels == TRUNK_LABEL) & (hybrid.strange | dilate_mask(hidden, MIXED_BORDER_PIXELS))
    arms = np.isin(own.labels, ARM_LABELS) | held
    other = arms | (own.labels < 0)
    gone, behind, before = (_in_the_picture(one, silhouette) for one in (limbs & ~around, hidden, other))
    alone = replace(silhouette, alpha=silhouette.alpha * (1 - gone))
    seen = mirrored_behind(figure.rgb, behind > 0, (silhouette.alpha > OPAQUE_ALPHA) & (gone == 0) & (before == 0))
    nothing = LimbSurfaces(np.zeros_like(limbs), np.zeros_like(limbs), body=covered, before=hybrid.hair)
    tiles = _painted(replace(figure, rgb=seen), alone, own, nothing, back)
    shown = limbs_alone(hybrid)
    relief = _made_of(figure, alone, fitted, own, trunk, tiles, _left_for_a_relief(triangles, shown))
    filled: BackTexture = "inpaint" if back == "inpaint" else "mirror"
    skin = bare_skin(
        silhouette.rgb,
        nose_colours(figure, silhouette),
        labels.bare.labels,
        hybrid.shell.pictured,
        shown.mesh.triangles,
    )
    if skin is not None:
        hybrid = replace(hybrid, strange=hybrid.strange | skin.strange)
    hides = dilate_mask(hybrid.before_the_body(labels.bare), MIXED_BORDER_PIXELS)
    unlike = hybrid.strange | bare_under_cloth(own) | hides
    texture = paint_shell(
        figure.rgb, silhouette, labels.bare, hybrid.shell, filled, shown.mesh.triangles, unlike, hybrid.framed, skin
    )
    texture = with_the_trunks_colours(texture, hybrid, tiles, figure, silhouette)
    shell = bind_shell(shown, figure, silhouette, fitted, texture)
    character = joined(shell, relief)
    return replace(character, mesh=fewer_triangles(character, triangles))


def _in_the_picture(mask: NDArray[np.bool_], silhouette: Silhouette) -> NDArray[np.float32]:
    """A mask (h, w) of the grid in the picture, (H, W) from 0 to 1."""
    size = (silhouette.alpha.shape[1], silhouette.alpha.shape[0])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return np.asarray(cv2.warpAffine(mask.astype(np.float32), silhouette.to_grid, size, flags=flags))


def _along_with_arms(mesh: ClosedMesh, labels: Labels) -> NDArray[np.bool_]:
    """What of an arm (h, w) the body has, too, and moves as that does: about the shoulder."""
    names = load_human().rig.names
    along = np.zeros(labels.labels.shape, np.bool_)
    for arm, side in zip(ARM_LABELS, ("Left", "Right"), strict=True):
        own = np.array(
            [name.startswith(side) and any(part in name for part in MOVING_ARM_JOINT_NAMES) for name in names]
        )
        goes = (mesh.layer == 0) & ((mesh.weights * own[mesh.bones]).sum(1) > MIN_ARM_WEIGHT)
        along |= mesh.pixels(np.flatnonzero(goes), along.shape) & (labels.labels == arm)
    return along


def _sleeve(mesh: ClosedMesh, arm: int, labels: Labels) -> NDArray[np.bool_]:
    """What the surface of an arm that is apart covers (h, w), without its hand."""
    hand = np.array(["Hand" in name for name in load_human().rig.names])
    worn = (mesh.limb == arm) & ((mesh.weights * hand[mesh.bones]).sum(1) < MIN_MOVED_BY_HAND_WEIGHT)
    return mesh.pixels(np.flatnonzero(worn), labels.labels.shape)
