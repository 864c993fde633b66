"""From the driver's track to the control points of the target, frame by frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.acting_options import ActingOptions, Part
from engine.face_animation.eyes.gaze import gaze
from engine.face_animation.motion_transfer.alignment import align
from engine.face_animation.motion_transfer.body_motion import (
    body_share,
    body_shift,
    hair_share,
    keep_at_borders,
    keep_hair_at_border,
    tracked_body,
    tracked_hair,
)
from engine.face_animation.motion_transfer.contour import even_expression, keep_inside, rim_distance
from engine.face_animation.motion_transfer.control_points import ControlPoints, carry_fiducials, carry_periphery
from engine.face_animation.motion_transfer.even_brows import brow_share, even_brows
from engine.face_animation.motion_transfer.expression_transfer import carry_expression, local_maps
from engine.face_animation.motion_transfer.far_side import FarSide
from engine.face_animation.motion_transfer.head_motion import HeadMotion, split_motion, turn_angles
from engine.face_animation.motion_transfer.head_proxy import (
    HeadProxy,
    build_head_proxy,
    chin_length,
    move_head,
    roll_head,
)
from engine.face_animation.motion_transfer.head_room import hold_back, skull_shift, turned_in_picture
from engine.face_animation.motion_transfer.landmark_residuals import LandmarkResiduals
from engine.face_animation.motion_transfer.lids_and_lips import (
    constrain_lids_and_lips,
    gap_limits,
    lid_ratio,
    open_lids,
)
from engine.face_animation.motion_transfer.lids_below_brows import keep_lids_below_brows
from engine.face_animation.motion_transfer.pose_refinement import refine_pose
from engine.face_animation.motion_transfer.turned_expression import even_out_turned
from engine.face_animation.motion_transfer.usual_lids import AS_AT_REST, UsualLids, usual_lids
from engine.face_animation.mouth.closing import ClosingLips
from engine.face_animation.mouth.lip_curves import construct_lips, thickness_shares
from engine.face_animation.mouth.lips_and_skin import keep_lips_off_skin, philtrum_compression
from engine.face_animation.mouth.smile_curve import SmileCurve
from engine.face_animation.smoothstep import smoothstep
from engine.geometry.registration.rigid import Similarity
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE, eye_distance
from engine.perception.face_track.track import FaceTrack

PLANE_SHARE = 0.65
"""Inside a face that the picture shows turned, the paper's plane counts this much beside the proxy turned in space:
its depth is hardly seen there, and errs."""
PLANE_TURN_DEGREES = (3.0, 10.0)
"""Degrees by which the picture's face is turned from which the plane begins to count so, and fully."""
PLANE_RISE_EYE_DISTANCES = 0.12
"""Eye distances inside the contour over which the plane's share rises to the full one."""
CONTROL_CHUNK_FRAMES = 32
"""Frames whose control points are computed together: enough for vectorised work, little memory."""


@dataclass(frozen=True)
class ControlMotion:
    """One frame.

    offsets : (C, 2) of the control points, pixels.
    depth : (C,) of them, smaller is nearer.
    look : (2, 2) of the irises, see `gaze.gaze`.
    behind : (C, 2) how far apart from them the points of the sheet behind the face are, see `far_side`.
    """

    frame: int
    offsets: NDArray[np.float32]
    depth: NDArray[np.float32]
    look: NDArray[np.float32]
    behind: NDArray[np.float32]


@dataclass(frozen=True)
class DriverFrames:
    """Some of a driver's frames, N of them.

    meshes : (N, 478, 3) pixels.
    periphery : (N, K, 2) pixels.
    trust : (N, K) in [0, 1]. These three are as in `FaceTrack`.
    faces : (N, 478, 2) the meshes in the driver's crop.
    """

    meshes: NDArray[np.float32]
    periphery: NDArray[np.float32]
    trust: NDArray[np.float32]
    faces: NDArray[np.float32]


@dataclass(frozen=True)
class _Acted:
    """What the target acts in N frames, whatever its head does.

    expression : (N, 478, 3) offsets on its upright face, pixels.
    look : (N, 2, 2) of its irises, see `gaze.gaze`.
    lids : (N, 14) how far they open, as `lid_ratio` has it.
    lips : (N, 2) how thick they are, as `thickness_shares` has it.
    philtrum : (N,) how far the skin under its nose is pressed, as `philtrum_compression` has it.
    """

    expression: NDArray[np.float64]
    look: NDArray[np.float32]
    lids: NDArray[np.float64]
    lips: NDArray[np.float64]
    philtrum: NDArray[np.float64]


class MotionTransfer:
    """Equation 1 for any frame of a driver, against the driver at rest; with a `proxy`, the head's part of it in 3D; corrected
    by `residuals`. What holds for all frames is prepared once.

    Parameters
    ----------
    rest : one frame, in which the driver shows what the target shows. target : (478, 3) mesh, pixels. proxy : None keeps to
        the plane. lids : what the driver's are usually like.
    """

    def __init__(
        self,
        rest: DriverFrames,
        target: NDArray[np.float32],
        control: ControlPoints,
        proxy: HeadProxy | None,
        options: ActingOptions,
        residuals: LandmarkResiduals | None = None,
        lids: UsualLids = AS_AT_REST,
    ):
        self._rest, self._around, self._trust = rest.meshes[0], rest.periphery[0], rest.trust[0]
        self._target, self._control, self._proxy, self._residuals, self._lids = target, control, proxy, residuals, lids
        self._driver = build_head_proxy(np.concatenate([self._rest[:, :2], self._around]), self._rest)
        self._phi = align(self._rest, target)
        self._turned = turned_in_picture(target)
        self._lips, self._smile = ClosingLips(self._rest, target), SmileCurve(self._rest, target)
        self._unit = float(eye_distance(target[:, :2]))
        self._maps = local_maps(self._phi, self._rest, target, float(eye_distance(self._rest[:, :2])))
        self._follow = part_weights(options.follow) * control.bare.astype(np.float32)
        self._far_side = FarSide(target, control.points)
        self._even = even_expression(target, control.usable[:MESH_SIZE])
        self._acts = options.strength * self._follow[:, None] * even_brows()
        self._head = options.strength if "head" in options.follow else 0.0
        self._eyes = options.strength if "eyes" in options.follow else 0.0
        self._mouth = min(options.strength, 1.0) if "mouth" in options.follow else 0.0
        self._correct = min(options.strength, 1.0) * self._follow

    def __call__(self, frames: DriverFrames) -> tuple[NDArray[np.float32], ...]:
        """Of each frame the `offsets` (N, C, 2), the `depth` (N, C), the `look` (N, 2, 2) and `behind` (N, C, 2) of a `ControlMotion`."""
        rest, target, control, proxy, phi = self._rest, self._target, self._control, self._proxy, self._phi
        motion = split_motion(frames.meshes, rest)
        if proxy is not None:
            around, trust = frames.periphery - self._around, frames.trust * self._trust
            motion = refine_pose(motion, self._driver, frames.meshes, around, trust)
        acted = self._acted(motion)
        expression = acted.expression
        scaled = scale_motion(motion, self._head)
        offsets = np.zeros((len(frames.meshes), len(control.points), 2), np.float32)
        depths, behind = np.zeros(offsets.shape[:2], np.float32), np.zeros_like(offsets)
        if proxy is None:
            offsets[:, :MESH_SIZE] = _face_in_plane(phi, scaled, expression, target)
            placed = self._corrected(frames, control.points[:MESH_SIZE] + offsets[:, :MESH_SIZE])
            carried = target[:, :2] + _face_in_plane(phi, scaled, np.zeros_like(expression), target)
            construct_lips(placed, carried, acted.lips)
            keep_lips_off_skin(placed, carried, acted.philtrum)
            offsets[:, control.periphery] = self._carried_around(frames)
        else:
            held = hold_back(scaled, phi, control.room, self._turned, control.face_room)
            solid = move_head(proxy, held, target)
            face = move_head(proxy, held, target, expression)[:, :MESH_SIZE]
            depths = solid[..., 2]
            depths[:, :MESH_SIZE] = face[..., 2]
            plane = _face_in_plane(phi, held, expression, target) + target[:, :2] - face[..., :2]
            placed = self._corrected(frames, face[..., :2] + plane_share(target)[:, None] * plane)
            rigid = solid[:, :MESH_SIZE, :2]
            placed = rigid + self._even @ (placed - rigid)
            open_lids(placed, rigid, acted.lids)
            keep_lids_below_brows(placed, rigid, control.bare)
            construct_lips(placed, rigid, acted.lips)
            keep_lips_off_skin(placed, rigid, acted.philtrum)
            offsets[:, MESH_SIZE:] = self._around_face(frames, motion, held, proxy, solid[..., :2], placed)
        offsets[:, :MESH_SIZE] = placed - control.points[:MESH_SIZE]
        if proxy is not None:
            skull = roll_head(proxy, held, target)
            skull[:, MESH_SIZE:] = control.points[MESH_SIZE:] + self._around_face(frames, motion, held, proxy, skull)
            behind[:] = self._far_side.withdrawn(control.points + offsets, skull)
        return offsets, depths, acted.look, behind

    def _corrected(self, frames: DriverFrames, placed: NDArray[np.floating]) -> NDArray[np.floating]:
        """Faces (N, 478, 2), pixels, by what the second look found; and kept inside their contour."""
        if self._residuals is not None:
            placed = placed + self._correct[:, None] * self._residuals.corrections(frames.faces, placed)
        keep_inside(placed, self._target, self._control.usable[:MESH_SIZE])
        return placed

    def _acted(self, motion: HeadMotion) -> _Acted:
        rest, target = self._rest, self._target
        even = even_out_turned(motion)
        expression = self._acts @ carry_expression(self._maps, self._phi, even)
        upright, acted = rest + even, target + expression
        ratio = 1 + self._eyes * (lid_ratio(upright, rest, target, self._lids) - 1)
        self._smile.lift(acted, upright, self._mouth)
        self._lips.close(acted, upright, self._mouth)
        ratio = np.clip(ratio, 0, np.repeat(gap_limits(target), 7))  # however strongly
        expression = constrain_lids_and_lips(acted, target, ratio, self._control.bare) - target
        look = self._eyes * gaze(rest + motion.expression, rest, np.clip(ratio[:, [3, 10]], 0, 1))
        thickness = 1 + self._mouth * (thickness_shares(upright, rest) - 1)
        return _Acted(expression, look.astype(np.float32), ratio, thickness, philtrum_compression(upright, rest))

    def _carried_around(self, frames: DriverFrames) -> NDArray[np.floating]:
        """(N, P, 2) what the driver's tracked points around the face say of the target's peripheral points, pixels."""
        places = self._control.points[self._control.periphery]
        if not frames.periphery.shape[1]:
            return np.zeros((len(frames.meshes), len(places), 2), np.float32)
        around, trust = frames.periphery - self._around, frames.trust * self._trust
        return self._head * carry_periphery(self._phi, self._around, around, trust, places, self._unit)

    def _around_face(
        self, frames: DriverFrames, motion: HeadMotion, held: HeadMotion, proxy: HeadProxy,
        solid: NDArray[np.floating], faces: NDArray[np.floating] | None = None,
    ) -> NDArray[np.float32]:  # fmt: skip
        """(N, C - 478, 2) what the points around the face do: the head's with the skull, the body's with the shoulders, the
        neck's between them; and what the face's contour does beyond the skull.

        solid : (N, C, 2) pixels, where the skull, `held` back, carries all points.
        faces : (N, 478, 2) pixels, where the face's are.
        """
        target, phi, oval = self._target, self._phi, list(FACE_OVAL)
        points, share = self._control.points[MESH_SIZE:], proxy.share[MESH_SIZE:, None]
        around, trust = frames.periphery - self._around, frames.trust * self._trust
        body = self._head * phi.offsets(tracked_body(self._rest, self._around, around, trust))
        body = body_shift(phi.offsets(skull_shift(held)[:, :2]), body, chin_length(target))
        hair = self._head * phi.offsets(tracked_hair(motion, self._driver, around, trust, phi.inverse()(points)))
        above = solid[:, MESH_SIZE:] - points + hair_share(target, points)[:, None] * hair
        below = body_share(target, points)[:, None] * body[:, None]
        beyond = 0.0 if faces is None else proxy.contour @ (faces[:, oval] - solid[:, oval])
        moved = np.asarray(share * above + (1 - share) * below + beyond, np.float32)
        keep_at_borders(moved, points, target, self._control.borders)
        keep_hair_at_border(moved, points, target, *self._control.hair_cut)
        return moved


def carry_motion(
    track: FaceTrack,
    neutral: int,
    target: NDArray[np.float32],
    control: ControlPoints,
    proxy: HeadProxy | None,
    options: ActingOptions,
    residuals: LandmarkResiduals | None = None,
) -> Iterator[ControlMotion]:
    """Equation 1 for every frame of a track, against its `neutral` one; the rest as `MotionTransfer` takes it."""

    def frames(start: int, stop: int) -> DriverFrames:
        faces = np.stack([track.in_crop(frame) for frame in range(start, stop)])
        some = slice(start, stop)
        return DriverFrames(track.meshes[some], track.periphery[some], track.trust[some], faces)

    lids = usual_lids(track.meshes, neutral, track.fps)
    transfer = MotionTransfer(frames(neutral, neutral + 1), target, control, proxy, options, residuals, lids)
    for start in range(0, len(track), CONTROL_CHUNK_FRAMES):
        carried = transfer(frames(start, min(start + CONTROL_CHUNK_FRAMES, len(track))))
        for k, one in enumerate(zip(*carried, strict=True)):
            yield ControlMotion(start + k, *one)


def _face_in_plane(phi: Similarity, motion: HeadMotion, expression: NDArray, target: NDArray) -> NDArray[np.float64]:
    """Equation 1, the paper's own form, for the rigid motion, and the expression: (N, 478, 2) offsets."""
    turned = np.einsum("nij,vj->nvi", motion.rotation, motion.neutral)
    rigid = motion.scale[:, None, None] * turned + motion.shift[:, None]
    return carry_fiducials(phi, rigid, motion.neutral, target) - target[:, :2] + expression[..., :2]


def plane_share(target: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478,) how much equation 1 in the plane counts beside the head turned in space, for a target's mesh."""
    slant = float(np.rad2deg(turn_angles(target[None], canonical_face())[0]))
    inside = -rim_distance(target, target[:, :2]) / float(eye_distance(target[:, :2]))
    return (
        PLANE_SHARE
        * np.clip((slant - PLANE_TURN_DEGREES[0]) / (PLANE_TURN_DEGREES[1] - PLANE_TURN_DEGREES[0]), 0, 1)
        * smoothstep(inside, 0, PLANE_RISE_EYE_DISTANCES)
    )


def scale_motion(motion: HeadMotion, strength: float) -> HeadMotion:
    """A motion of the head made stronger or weaker; 0 leaves it where the neutral frame has it."""
    if strength == 1.0:
        return motion
    centre = motion.neutral.mean(axis=0)
    moved = motion.scale[:, None] * (motion.rotation @ centre) + motion.shift - centre
    rotation = np.array([cv2.Rodrigues(strength * cv2.Rodrigues(r)[0])[0] for r in motion.rotation])
    scale = motion.scale**strength
    shift = centre + strength * moved - scale[:, None] * (rotation @ centre)
    return HeadMotion(motion.neutral, scale, rotation, shift, motion.expression)


def part_weights(follow: tuple[Part, ...]) -> NDArray[np.float32]:
    """(478,) how much each vertex's expression follows the driver, 1 for the parts named in `follow`.

    The parts meet softly: brows above the eyes, eyes around them, mouth from the nose's wings down.
    """
    y = canonical_face()[:, 1].astype(float)
    brows = brow_share()
    mouth = smoothstep(y, 0.3, 0.55)
    weights = {"brows": brows, "mouth": mouth, "eyes": (1 - brows) * (1 - mouth)}
    total = np.sum([weights[part] for part in weights if part in follow], axis=0) if follow else 0.0
    return np.broadcast_to(np.asarray(total, np.float32), (len(y),)).copy()
