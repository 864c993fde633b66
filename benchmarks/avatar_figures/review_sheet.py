"""An avatar to be reviewed: its shape, its sides, its face in expressions, hands and soles, and what it does in motion.

    python -m benchmarks.avatar_figures.review_sheet AVATAR.glb OUT.png

Needs the delivered file alone: no film and no truth. Shape is drawn in one colour beside the texture.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.contact_sheet import Row, contact_sheet, write_sheet
from benchmarks.scan_studio.scenery.drawing import draw_over, empty_depths, textured_mesh
from engine.avatar.acting import built_in_clips
from engine.avatar.avatar import Avatar
from engine.avatar.earlier_avatar import read_avatar
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.morph_target import morphed
from engine.geometry.rigging.skinning import skin
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms

WALL_GREY_LEVEL = 110
"""Grey level around the avatar."""
CLAY_GREY_LEVEL = 190
"""Grey level of what is drawn without its texture."""
LIGHT_DIRECTION = (-0.4, 0.5, 0.75)
"""Towards the light, from right, above and before the avatar as the camera sees it."""
TEXTURE_LIGHT_SHARE, CLAY_LIGHT_SHARE = 0.25, 0.65
"""Share of the light that comes from its direction; the rest is everywhere."""
DRAWN_SUPERSAMPLING = 2
"""Along a side of a pixel of the sheet."""
LENS_FOCAL_PIXELS = 900.0
"""Pixels of the cameras."""
NEAR_SIZE, WHOLE_SIZE = (380, 330), (560, 330)
"""Height and width of pictures of parts and of all of the avatar."""
EXPRESSIONS: tuple[Mapping[str, float], ...] = (
    {"eyeBlinkLeft": 1, "eyeBlinkRight": 1},
    {"mouthSmileLeft": 1, "mouthSmileRight": 1},
    {"jawOpen": 1},
    {"browInnerUp": 1, "jawOpen": 0.3},
    {"mouthPucker": 1},
    {"mouthFrownLeft": 1, "mouthFrownRight": 1, "browDownLeft": 1, "browDownRight": 1},
)
"""Face units and their weights."""
MOMENTS: Mapping[str, Sequence[tuple[str, float, float]]] = {
    "walk": [("walk", k / 8, turn) for k, turn in enumerate((0.0, 0.8, 1.57, 3.14, -0.8, -1.57, 0.0, 0.0))],
    "wave, dance, sit": [
        *(("wave", 0.5, 0.0), ("wave", 0.5, 3.14), ("dance", 0.3, 0.5), ("dance", 0.6, -0.5)),
        *(("dance", 0.6, 3.14), ("sit", 0.8, 0.6), ("sit", 0.8, 2.6)),
    ],
}
"""Built-in motions, how far in them a moment is, and the turn of the camera about the avatar, by title."""

Picture = NDArray[np.uint8]
Places = NDArray[np.floating]


class _Stage:
    """An avatar before cameras."""

    def __init__(self, avatar: Avatar) -> None:
        self.avatar, self.mesh = avatar, avatar.mesh
        self.standing = self.posed(avatar.filmed, 0)

    def posed(self, clip: Clip, frame: int, rest: Places | None = None) -> NDArray[np.float32]:
        """(V, 3) the vertices in a frame of a clip, from those at `rest`."""
        turns = pose_transforms(self.mesh.skeleton, clip.rotations[frame : frame + 1], clip.root[frame : frame + 1])[0]
        mesh = self.mesh
        return np.asarray(skin(mesh.vertices if rest is None else rest, mesh.bones, mesh.weights, turns))

    def acting(self, weights: Mapping[str, float]) -> NDArray[np.float32]:
        """(V, 3) the vertices as filmed, but with an expression."""
        values = np.array([weights.get(one.name, 0.0) for one in self.avatar.morphs], np.float32)
        return self.posed(self.avatar.filmed, 0, morphed(self.mesh.vertices, self.avatar.morphs, values))

    def placed(self, joint: str, offset: Sequence[float] = (0.0, 0.0, 0.0)) -> NDArray[np.float64]:
        """(3,) where what lies off a joint by so much in T-pose is as filmed, metres."""
        skeleton, filmed = self.mesh.skeleton, self.avatar.filmed
        number = skeleton.names.index(joint)
        turn = pose_transforms(skeleton, filmed.rotations[:1], filmed.root[:1])[0][number]
        return np.asarray(turn[:3, :3] @ (skeleton.heads[number] + np.asarray(offset)) + turn[:3, 3])

    def facing(self, joint: str, way: Sequence[float]) -> NDArray[np.float64]:
        """(3,) a way in T-pose as it is turned with a joint, as filmed."""
        return self.placed(joint, way) - self.placed(joint)

    def seen(
        self,
        vertices: Places,
        at: Places,
        way: Places | Sequence[float],
        size: tuple[int, int] = NEAR_SIZE,
        clay: bool = False,
    ) -> Picture:
        """The avatar as a camera sees it that stands off `at` by a `way`, metres, and looks there; in one colour if of `clay`."""
        height, width = size
        lens = Camera((0.0, 0.0, 1.0), LENS_FOCAL_PIXELS, ((width - 1) / 2, (height - 1) / 2), size)
        camera = lens.aimed(list(np.asarray(at) + way), list(at)).scaled(DRAWN_SUPERSAMPLING)
        light = np.array(camera.axes).T @ LIGHT_DIRECTION / np.linalg.norm(LIGHT_DIRECTION)
        facing = np.clip(vertex_normals(vertices.astype(np.float64), self.mesh.triangles) @ light, 0, 1)
        share = CLAY_LIGHT_SHARE if clay else TEXTURE_LIGHT_SHARE
        shade = (1 - share + share * facing).astype(np.float32)
        plain = np.full((2, 2, 3), CLAY_GREY_LEVEL, np.uint8)
        triangles = self.mesh.triangles.astype(np.int32)
        drawn = textured_mesh(triangles, self.mesh.uv, triangles, shade, plain if clay else self.mesh.texture)
        picture = np.full((*camera.size, 3), WALL_GREY_LEVEL, np.uint8)
        draw_over(picture, empty_depths(camera), drawn, vertices, camera)
        return np.asarray(cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA))


def review_sheet(avatar: Avatar) -> Picture:
    """The sheet (H, W, 3) of all that is to be looked at."""
    stage = _Stage(avatar)
    standing = stage.standing
    middle = np.append(standing[:, :1].mean(), [np.ptp(standing[:, 1]) / 2, standing[:, 2].mean()])
    head, mouth = stage.placed("Head", (0, 0.09, 0.02)), stage.placed("Head", (0, 0.022, 0.07))
    turns = np.arange(8) * np.pi / 4
    rows = []
    for clay in (True, False):
        ways = [(2.9 * np.sin(turn), 0.1, 2.9 * np.cos(turn)) for turn in turns]
        rows.append(Row([stage.seen(standing, middle, way, WHOLE_SIZE, clay) for way in ways], "eight sides"))
    for clay in (True, False):
        about = [stage.facing("Head", (0.7 * np.sin(turn), 0, 0.7 * np.cos(turn))) for turn in turns]
        rows.append(Row([stage.seen(standing, head, way, clay=clay) for way in about], "head"))
    faces = [stage.acting(one) for one in EXPRESSIONS]
    for at, way in ((head - [0, 0.02, 0], (0.25, 0.0, 0.55)), (mouth, (0.0, 0.0, 0.3))):
        rows.append(Row([stage.seen(face, at, stage.facing("Head", way)) for face in faces], "expressions"))
    rows.append(Row(_parts(stage), "hands, soles, feet, crotch, armpits"))
    rows += [Row(some, title) for title, some in _moments(stage).items()]
    return contact_sheet(rows)


def _parts(stage: _Stage) -> list[Picture]:
    """Parts in which faults are usual, from near."""
    found = []
    for side in SIDE_NAMES:
        at = stage.placed(f"{side}HandMiddle1")
        found += [stage.seen(stage.standing, at, way) for way in ((0, 0, 0.4), (0, 0.1, -0.4))]
    for side, outwards in zip(SIDE_NAMES, (1, -1), strict=True):
        foot, arm = (
            stage.placed(f"{side}Foot", (0, -0.04, 0.06)),
            stage.placed(f"{side}Arm", (0.05 * outwards, -0.1, 0)),
        )
        found += [stage.seen(stage.standing, foot, way) for way in ((0, -0.5, 0.25), (0.3 * outwards, 0.3, 0.4))]
        found.append(stage.seen(stage.standing, arm, (0.2 * outwards, -0.35, 0.5)))
    found.append(stage.seen(stage.standing, stage.placed("Hips", (0, -0.15, 0)), (0, -0.45, 0.6)))
    found.append(stage.seen(stage.standing, stage.placed("Head", (0, 0.09, 0.02)), (0, 0.9, 0.1)))
    return found


def _moments(stage: _Stage) -> dict[str, list[Picture]]:
    """Moments of built-in motions, by title."""
    clips = {clip.name: clip for clip in built_in_clips(stage.mesh, 30.0)}
    found: dict[str, list[Picture]] = {}
    for title, moments in MOMENTS.items():
        for name, share, turn in moments:
            clip = clips[name]
            posed = stage.posed(clip, int(share * (len(clip.rotations) - 1)))
            at = np.array([posed[:, 0].mean(), 0.95, posed[:, 2].mean()])
            way = (3.1 * np.sin(turn), 0.05, 3.1 * np.cos(turn))
            found.setdefault(title, []).append(stage.seen(posed, at, way, WHOLE_SIZE))
    return found


def main() -> None:
    """Read, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("avatar", type=Path)
    parser.add_argument("out", type=Path)
    asked = parser.parse_args()
    write_sheet(asked.out, review_sheet(read_avatar(asked.avatar)))


if __name__ == "__main__":
    main()
