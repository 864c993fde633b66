"""Both eyes of an animated face: the lids close over eyeballs that look elsewhere."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import prepare_eyes
from engine.face_animation.eyes.eyes import draw_eye, lid_closing_share, shut_share
from engine.face_animation.eyes.gaze import iris_shifts
from engine.face_animation.eyes.lash_line import draw_lashes
from engine.face_animation.eyes.lid import draw_lid
from engine.face_animation.eyes.socket_frame import socket_frame
from engine.face_animation.eyes.socket_skin import socket_skin
from engine.face_animation.target_face import TargetFace


class EyesAndLids:
    """The eyeballs and the lids' skin of a target; an eye that its picture does not show stays as the warp has it."""

    def __init__(self, target: TargetFace):
        self._eyeballs = prepare_eyes(target.rgb, target.mesh)
        self._sockets = [socket_skin(target.rgb, target.mesh, side) for side in range(2)]

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], look: NDArray[np.float32]) -> None:
        """Draw them in place where a `face` (478, 2) of the frame (H, W, 3) has them, pixels; `look` (2, 2) as `gaze.gaze`."""
        for side, (eyeball, shift) in enumerate(zip(self._eyeballs, iris_shifts(self._eyeballs, look), strict=True)):
            if eyeball is not None and shift is not None:
                draw_eye(frame, eyeball, face, side, shift)
                closing, shut = (share(eyeball, face, side) for share in (lid_closing_share, shut_share))
                socket = socket_frame(face, side)
                draw_lid(frame, self._sockets[side], socket, closing, shut)
                draw_lashes(frame, eyeball.lashes, socket, closing)
