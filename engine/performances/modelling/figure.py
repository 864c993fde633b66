"""The actor's body: a person made from the template, posed by face units, head turns and breath."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body import Phenotype, Template, load_shape_space
from engine.body.rig import Rig
from engine.body.subdivision import catmull_clark
from engine.body.template import load_drawn_template, load_rig
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.skinning import bone_transforms, skin
from engine.performances.modelling.eyes import EYEBALL_RADIUS_METRES, build_eyeball, profile
from engine.performances.modelling.lids import Lids, build_lids

FIGURE_PHENOTYPE = Phenotype(age=0.52, gender=0.86, muscle=0.48, weight=0.5, caucasian=0.7, asian=0.15, african=0.15)

FACE_FEATURES = {
    "r-eye-scale-incr": 0.22,
    "l-eye-scale-incr": 0.22,
    "neck-scale-horiz-decr": 0.35,
    "neck-scale-depth-decr": 0.25,
}
"""Local changes that make the average face a person."""

CLOSED_LIPS = {
    "jawOpen": -0.035,
    "mouthPressLeft": 0.10,
    "mouthPressRight": 0.10,
    "mouthSmileLeft": 0.06,
    "mouthSmileRight": 0.05,
}
"""The template's lips stand a little apart: with these units they meet."""

BLINK_UNITS = ("eyeBlinkLeft", "eyeBlinkRight")
"""Units that `engine.performances.modelling.lids` carries out: their weight is the share of the way to a shut eye."""

NECK_SHARES = {"neck01": 0.12, "neck02": 0.16, "neck03": 0.22, "head": 0.5}
"""How a turn of the head is shared out between the joints."""

EYEBALL_SKIN_GAP_METRES = 0.0006
"""Metres between the eyeball and the surface of the skin on it."""

MIN_FRAMED_HEIGHT_METRES = 0.45
"""Metres: what lies lower in the template's rest pose is never in the picture."""


@dataclass(frozen=True)
class Pose:
    """One moment of the performance. Angles in degrees, lengths in metres.

    units : weights of the face units.
    head : (pitch, yaw, roll), positive down, to the sitter's left, towards the sitter's left shoulder.
    lean : how far the whole body moves (x, y, z).
    gaze : (up, left) of the eyes within the head.
    breath : 0 empty to 1 full.
    """

    units: Mapping[str, float] = field(default_factory=dict)
    head: tuple[float, float, float] = (0.0, 0.0, 0.0)
    lean: tuple[float, float, float] = (0.0, 0.0, 0.0)
    gaze: tuple[float, float] = (0.0, 0.0)
    breath: float = 0.0


@dataclass(frozen=True)
class Eye:
    """An eyeball of the rest pose: its centre (3,), metres."""

    centre: NDArray[np.float64]


@dataclass(frozen=True)
class Figure:
    """What does not change from frame to frame; B bones.

    template : what the figure is made of.
    rig : its bones.
    rest : (V, 3) float32 metres, the person's own template, arms down.
    heads : (B, 3) float32 metres, the joints of the rest pose.
    fine : (N, V) sparse, makes the skin of the template's vertices: twice subdivided, cut to what the picture shows.
    quads : (F, 4) int32, those of the skin.
    coarse : (M, V) sparse, the same once subdivided, for shadows.
    coarse_quads : (E, 4) int32, those of the coarse skin.
    eyes : left, then right.
    lids : left, then right.
    """

    template: Template
    rig: Rig
    rest: NDArray[np.float32]
    heads: NDArray[np.float32]
    fine: sp.csr_array
    quads: NDArray[np.int32]
    coarse: sp.csr_array
    coarse_quads: NDArray[np.int32]
    eyes: tuple[Eye, Eye]
    lids: tuple[Lids, Lids]


@dataclass(frozen=True)
class PosedFigure:
    """A pose carried out.

    cage : (V, 3) float32 metres, the template's vertices.
    skin : (N, 3) float32 metres, the surface subdivided twice.
    coarse_skin : (M, 3) float32 metres, the surface subdivided once.
    head : (4, 4) float64, carries the skull from its rest pose.
    jaw : (4, 4) float64, carries the lower teeth from theirs.
    eyes : (4, 4) float64 each, left, then right.
    """

    cage: NDArray[np.float32]
    skin: NDArray[np.float32]
    coarse_skin: NDArray[np.float32]
    head: NDArray[np.float64]
    jaw: NDArray[np.float64]
    eyes: tuple[NDArray[np.float64], NDArray[np.float64]]


def build_figure() -> Figure:
    """Make the actor's body.

    Its face units are the drawn ones: the videos that ship were rendered with them.
    """
    template, rig = load_drawn_template(), load_rig("default")
    shape = load_shape_space().shape(FIGURE_PHENOTYPE, FACE_FEATURES) + template.face_units.displacement(CLOSED_LIPS)
    arms_down = _arms_down(rig, shape)
    skin_quads = template.quads[template.faces("body")]
    framed = arms_down[skin_quads][:, :, 1].min(1) > MIN_FRAMED_HEIGHT_METRES
    near = np.abs(arms_down[skin_quads][:, :, 0]).max(1) < 0.26
    cage = skin_quads[framed & near]
    once = catmull_clark(cage, len(shape))
    twice = catmull_clark(once.quads, once.points.shape[0])
    fine, quads = _compact(sp.csr_array(twice.points @ once.points), twice.quads)
    coarse, coarse_quads = _compact(once.points, once.quads)
    left, right = (_fit_eye(arms_down[template.vertices_of(f"{side}_eye")]) for side in ("left", "right"))
    lids = [
        build_lids(
            fine,
            triangulate(quads),
            arms_down,
            build_eyeball(),
            eye.centre,
            template.face_units.displacement({name: 1}),
        )
        for eye, name in zip((left, right), BLINK_UNITS, strict=True)
    ]
    heads = rig.joints(arms_down)[0]
    return Figure(
        *(template, rig, arms_down, heads, fine, quads, coarse, coarse_quads), (left, right), (lids[0], lids[1])
    )


def pose_figure(figure: Figure, pose: Pose) -> PosedFigure:
    """Carry out a pose."""
    units = {name: weight for name, weight in pose.units.items() if name not in BLINK_UNITS}
    moved = figure.rest + figure.template.face_units.displacement(units)
    shut = [lids.close(moved, pose.units.get(name, 0.0)) for lids, name in zip(figure.lids, BLINK_UNITS, strict=True)]
    moved = moved + shut[0] + shut[1]
    transforms = bone_transforms(figure.rig.parents, figure.heads, _rotations(figure.rig, pose), np.asarray(pose.lean))
    cage = skin(moved, figure.rig.bones, figure.rig.weights, transforms)
    head = transforms[figure.rig.index("head")]
    teeth = figure.template.vertices_of("lower_teeth")
    jaw = head @ rigid_motion(figure.rest[teeth], moved[teeth])
    eyes = tuple(head @ _about(eye.centre, _gaze(pose.gaze)) for eye in figure.eyes)
    surfaces = []
    for points in (figure.fine, figure.coarse):
        surface = (points @ cage).astype(np.float32)
        for eye, motion in zip(figure.eyes, eyes, strict=True):
            _keep_off(surface, motion, motion[:3, :3] @ eye.centre + motion[:3, 3])
        surfaces.append(surface)
    return PosedFigure(cage, surfaces[0], surfaces[1], head, jaw, eyes)


def rigid_motion(before: NDArray[np.floating], after: NDArray[np.floating]) -> NDArray[np.float64]:
    """The rotation and shift, (4, 4), that best carry (N, 3) points to others, by least squares (Kabsch)."""
    b, a = np.asarray(before, np.float64), np.asarray(after, np.float64)
    turn, _ = Rotation.align_vectors(a - a.mean(0), b - b.mean(0))
    motion = np.eye(4)
    motion[:3, :3] = turn.as_matrix()
    motion[:3, 3] = a.mean(0) - motion[:3, :3] @ b.mean(0)
    return motion


def _rotations(rig: Rig, pose: Pose) -> NDArray[np.float64]:
    rotations = np.tile(np.eye(3), (len(rig.names), 1, 1))
    pitch, yaw, roll = pose.head
    for name, share in NECK_SHARES.items():
        turn = Rotation.from_euler("YXZ", [share * yaw, share * pitch, -share * roll], degrees=True)
        rotations[rig.index(name)] = turn.as_matrix()
    for side, sign in (("L", 1), ("R", -1)):
        lift = Rotation.from_euler("z", sign * 1.1 * pose.breath, degrees=True)
        rotations[rig.index(f"clavicle.{side}")] = lift.as_matrix()
    rotations[rig.index("spine01")] = Rotation.from_euler("x", -0.5 * pose.breath, degrees=True).as_matrix()
    return rotations


def _arms_down(rig: Rig, shape: NDArray[np.float32]) -> NDArray[np.float32]:
    rotations = np.tile(np.eye(3), (len(rig.names), 1, 1))
    for side, sign in (("L", 1), ("R", -1)):
        for bone, angle in (("clavicle", -5), ("upperarm01", -34)):
            rotations[rig.index(f"{bone}.{side}")] = Rotation.from_euler("z", sign * angle, degrees=True).as_matrix()
    return skin(shape, rig.bones, rig.weights, bone_transforms(rig.parents, rig.joints(shape)[0], rotations))


def _compact(points: sp.csr_array, quads: NDArray[np.int32]) -> tuple[sp.csr_array, NDArray[np.int32]]:
    """Leave out the vertices that no face uses."""
    used, renumbered = np.unique(quads, return_inverse=True)
    return sp.csr_array(points[used]), renumbered.reshape(-1, 4).astype(np.int32)


def _fit_eye(points: NDArray[np.float32]) -> Eye:
    """The sphere through the back of an eye of the template; its surface is the limit surface of that cage."""
    p = points[points[:, 2] < np.quantile(points[:, 2], 0.7)].astype(np.float64)
    solution = np.linalg.lstsq(np.c_[2 * p, np.ones(len(p))], (p**2).sum(1), rcond=None)[0]
    return Eye(solution[:3])


def _keep_off(surface: NDArray[np.float32], eye: NDArray[np.float64], centre: NDArray[np.float64]) -> None:
    """Push lid skin that a straight blend would sink into the eyeball out to its surface, in place.

    `eye` (4, 4) places the eye's own axes (it looks along +z), whose origin `centre` lies at its middle.
    """
    near = np.flatnonzero(np.abs(surface - centre).max(1) < 1.5 * EYEBALL_RADIUS_METRES)
    local = (surface[near] - centre) @ eye[:3, :3]
    distance = np.linalg.norm(local, axis=1)
    cosine = local[:, 2] / np.maximum(distance, 1e-9)
    wanted = profile(cosine) + EYEBALL_SKIN_GAP_METRES
    inside = (distance < wanted) & (cosine > 0.25)
    local[inside] *= (wanted[inside] / distance[inside])[:, None]
    surface[near] = local @ eye[:3, :3].T + centre


def _gaze(angles: tuple[float, float]) -> NDArray[np.float64]:
    up, left = angles
    return Rotation.from_euler("YX", [left, -up], degrees=True).as_matrix()


def _about(centre: NDArray[np.float64], rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    motion = np.eye(4)
    motion[:3, :3] = rotation
    motion[:3, 3] = centre - rotation @ centre
    return motion
