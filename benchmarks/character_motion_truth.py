"""Characters in motion against the truth: rigged people are photographed, woken, and play what they themselves play.

    python -m benchmarks.character_motion_truth [--only WORD] [--clip walk] [--back mirror] [--sheet PICTURE.png]

A person of known shape (`benchmarks.scan_studio.people.rigged_people`) is drawn into a photograph of a place in a known pose. From that
picture alone the character is made, as for any user. Then both play the same clip, hips on hips and equally high, and eight
views of twelve moments are compared.

"IoU" is of silhouettes: of all views, of those from the front, the sides and behind. "colour" is the mean distance in
CIE Lab of the truth's pixels from the nearest colour within 3 pixels, where both are. "apart" is the share of the
character's pixels in pieces that hang apart. "stretched" is the share in triangles of more than four times their
pictured area. "foreign" is the share of colours that the person has nowhere, as the room's. "template" is the bare
fitted template in the mean colours of its parts, "posed" how far its limbs are from their true directions, degrees.
`michelle` has no human proportions and counts in no mean.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks.character_figures.steps import Woken, wake
from benchmarks.known_truth.known_person import PERSON_PICTURE_SIZE, Person, draw_into
from benchmarks.known_truth.known_places import places
from benchmarks.known_truth.scanned_bodies import texture_painter
from benchmarks.presentation.contact_sheet import Row, at_height, contact_sheet, write_sheet
from benchmarks.presentation.tables import machine, mean_row, table
from benchmarks.scan_studio.people.pictured_poses import POSES
from benchmarks.scan_studio.people.rigged_people import BONE_END_JOINTS, T_POSE_HEIGHT_METRES, held_pose, read_rigged
from benchmarks.scan_studio.people.scanned_people import RIGGED_PEOPLE
from benchmarks.shared_media import media
from engine.body.parts import BODY_PARTS, vertex_parts
from engine.character.fit.rest_skeleton import rest_skeleton
from engine.character.fit.template_fit import load_human
from engine.character.texture.texture import BackTexture
from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.clip import Clip
from engine.motion.edit import in_place
from engine.motion.kinematics import pose_transforms
from engine.motion.library import CLIPS, built_in
from engine.render.rasterisation.rasteriser import rasterise
from engine.render.scene.character import draw_character, prepare_character

VIEW_YAW_DEGREES = tuple(range(0, 360, 45))
"""Degrees from the front."""
MOMENTS_PER_CLIP = 12
"""Of a clip."""
VIEW_SIDE_PIXELS = 320
"""Pixels of a view's height and width."""
COLOUR_SEARCH_PIXELS = 3
"""Pixels in which the nearest colour is looked for."""
MAX_AREA_RATIO = 4.0
"""Times its pictured area from which a triangle is stretched."""
MIN_FOREIGN_COLOUR_DISTANCE = 20.0
"""CIE Lab units from which a colour is none of the person's."""
COUNTED_PEOPLE = ("readyplayer.me", "soldier")
"""Who counts in means."""


@dataclass(frozen=True)
class Played:
    """What eight views of twelve moments show, means."""

    iou: float
    front: float
    side: float
    back: float
    colour: float
    colour_behind: float
    apart: float
    stretched: float
    foreign: float

    @property
    def row(self) -> list[float]:
        distances = [self.iou, self.front, self.side, self.back, self.colour, self.colour_behind]
        return distances + [100 * share for share in (self.apart, self.stretched, self.foreign)]


COLUMN_TITLES = ("IoU", "front", "side", "back", "colour", "of the back", "apart %", "stretched %", "foreign %")
COLUMN_DIGITS = (3, 3, 3, 3, 1, 1, 2, 2, 2)


class Player:
    """A mesh that plays a clip, and is looked at from all sides."""

    def __init__(self, mesh: SkinnedMesh, clip: Clip):
        self.mesh, self.clip, self.subject = mesh, in_place(clip), prepare_character(mesh)
        self.scale = T_POSE_HEIGHT_METRES / float(np.ptp(mesh.vertices[:, 1]))
        self.hips = mesh.skeleton.index("Hips")

    def posed(self, share: float) -> NDArray[np.float32]:
        """Its vertices (V, 3) at a share of the clip: equally high, the hips above the origin."""
        frame = int(share * len(self.clip.rotations))
        return self.held(Clip("", 1.0, self.clip.rotations[[frame]], self.clip.root[[frame]]))

    def held(self, clip: Clip) -> NDArray[np.float32]:
        """This person held in the only frame of a clip."""
        mesh = self.mesh
        transforms = pose_transforms(mesh.skeleton, clip.rotations, clip.root)[0]
        vertices = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
        return np.asarray((vertices - clip.root[0] * [1, 0, 1]) * self.scale, np.float32)


def camera_at(degrees: int) -> Camera:
    """Level, and as far away as a picture is taken from."""
    turn, middle = np.radians(degrees), np.array([0.0, T_POSE_HEIGHT_METRES / 2, 0.0])
    plain = Camera(
        (0, 0, 0),
        2.4 * VIEW_SIDE_PIXELS,
        ((VIEW_SIDE_PIXELS - 1) / 2, (VIEW_SIDE_PIXELS - 1) / 2),
        (VIEW_SIDE_PIXELS, VIEW_SIDE_PIXELS),
    )
    return plain.aimed(middle + 3 * T_POSE_HEIGHT_METRES * np.array([np.sin(turn), 0.0, np.cos(turn)]), middle)


def play(truth: Player, made: Player, pictured: NDArray[np.float32]) -> Played:
    """Compare two who play the same; `pictured` (V, 3): the vertices of the one made as they were in the picture."""
    areas = _areas(pictured, made.mesh.triangles)
    own = _lab(truth.mesh.texture[::8, ::8].reshape(-1, 1, 3)).reshape(-1, 3)
    found: list[tuple[int, float, float, float, float, float]] = []
    for moment in range(MOMENTS_PER_CLIP):
        a, b = truth.posed(moment / MOMENTS_PER_CLIP), made.posed(moment / MOMENTS_PER_CLIP)
        large = _areas(b, made.mesh.triangles) > MAX_AREA_RATIO * np.maximum(areas, 1e-8)
        for degrees in VIEW_YAW_DEGREES:
            camera = camera_at(degrees)
            true, drawn = (draw_character(one.subject, at, camera) for one, at in ((truth, a), (made, b)))
            mask, shown = true.alpha > 0.5, drawn.alpha > 0.5
            seen = rasterise(camera.project(b), made.mesh.triangles, camera.size, perspective=True).triangle
            found.append(
                (
                    degrees,
                    float((mask & shown).sum() / (mask | shown).sum()),
                    _colour_distance(true.rgb, drawn.rgb, mask & shown, shown),
                    _apart(shown),
                    float(large[seen[seen >= 0]].mean()),
                    _foreign(drawn.rgb[shown & (drawn.alpha > 0.99)], own),
                )
            )
    values = np.array(found)
    at = values[:, 0]

    def mean(column: int, *degrees: int) -> float:
        return float(values[np.isin(at, degrees or VIEW_YAW_DEGREES), column].mean())

    return Played(
        *(mean(1), mean(1, 0, 45, 315), mean(1, 90, 270), mean(1, 135, 180, 225)),
        *(mean(2), mean(2, 135, 180, 225), mean(3), mean(4), mean(5)),
    )


def _areas(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> NDArray[np.float64]:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)


def _lab(rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
    return np.asarray(cv2.cvtColor(rgb.astype(np.float32) / 255, cv2.COLOR_RGB2LAB))


def _colour_distance(
    true: NDArray[np.uint8], drawn: NDArray[np.uint8], where: NDArray[np.bool_], shown: NDArray[np.bool_]
) -> float:
    first, second = _lab(true), _lab(drawn)
    second[~shown] = 1e3
    nearest = np.full(where.sum(), np.inf)
    for y in range(-COLOUR_SEARCH_PIXELS, COLOUR_SEARCH_PIXELS + 1):
        for x in range(-COLOUR_SEARCH_PIXELS, COLOUR_SEARCH_PIXELS + 1):
            if x * x + y * y <= COLOUR_SEARCH_PIXELS**2:
                moved = np.roll(second, (y, x), (0, 1))
                nearest = np.minimum(nearest, np.linalg.norm(moved[where] - first[where], axis=-1))
    return float(nearest.mean()) if len(nearest) else float("nan")


def _apart(shown: NDArray[np.bool_]) -> float:
    sizes = np.bincount(cv2.connectedComponents(shown.astype(np.uint8), connectivity=8)[1][shown])[1:]
    return float(1 - sizes.max() / sizes.sum()) if len(sizes) else 0.0


def _foreign(colours: NDArray[np.uint8], own: NDArray[np.float32]) -> float:
    """The share of colours (P, 3) that are far from all of one's own (N, 3), CIE Lab."""
    bins = np.unique((own // 4).astype(int), axis=0) * 4 + 2
    some = _lab(colours[::4][None])[0]
    away = np.min([np.linalg.norm(some - one, axis=1) for one in bins], axis=0)
    return float((away > MIN_FOREIGN_COLOUR_DISTANCE).mean())


def template_of(woken: Woken) -> SkinnedMesh:
    """The bare fitted template in T-pose, each part in the median of the colours that the picture shows of it."""
    human, coefficients = load_human(), woken.fitted.fit.coefficients
    vertices = human.space.vertices(coefficients)
    used = np.unique(human.triangles)
    number = np.zeros(len(vertices), np.int32)
    number[used] = np.arange(len(used))
    labels = woken.labels.labels
    rgb = cv2.warpAffine(woken.figure.rgb, woken.silhouette.to_grid, labels.shape[::-1])
    palette = [
        np.median(rgb[labels == part], axis=0) if (labels == part).any() else np.median(rgb[labels >= 0], axis=0)
        for part in range(len(BODY_PARTS))
    ]
    texture = np.repeat(np.repeat(np.array([palette], np.uint8), 8, 0), 8, 1)
    part = np.asarray(vertex_parts(human.rig), np.intp)[used]
    uv = np.stack([(part + 0.5) / len(BODY_PARTS), np.full(len(part), 0.5)], 1).astype(np.float32)
    ground = np.float32(vertices[used, 1].min())
    skeleton = rest_skeleton(woken.fitted, human.space)
    heads = human.space.skeleton(coefficients).heads - np.array([0, ground, 0], np.float32)
    strongest = np.argsort(-human.rig.weights[used], 1)[:, :4]
    weights = np.take_along_axis(human.rig.weights[used], strongest, 1)
    return SkinnedMesh(
        type(skeleton)(skeleton.names, skeleton.parents, heads),
        vertices[used] - np.array([0, ground, 0], np.float32),
        number[human.triangles].astype(np.int32),
        uv,
        np.take_along_axis(human.rig.bones[used], strongest, 1).astype(np.uint8),
        (weights / weights.sum(1, keepdims=True)).astype(np.float32),
        texture,
    )


def limbs_off(truth: NDArray[np.float32], skeleton: SkinnedMesh, woken: Woken) -> float:
    """By how many degrees the limbs of the character, as pictured, point elsewhere than the true ones, in the mean."""
    character = woken.character
    names, transforms = (
        character.mesh.skeleton.names,
        pose_transforms(character.mesh.skeleton, character.pictured.rotations, character.pictured.root)[0],
    )
    rest = character.mesh.skeleton.heads
    made = np.einsum("jab,jb->ja", transforms[:, :3, :3], rest) + transforms[:, :3, 3]
    off = []
    for name, end in BONE_END_JOINTS.items():
        if "Hand" in name or end not in skeleton.skeleton.names:
            continue
        a = truth[skeleton.skeleton.index(end)] - truth[skeleton.skeleton.index(name)]
        b = made[names.index(end)] - made[names.index(name)]
        off.append(np.degrees(np.arccos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1))))
    return float(np.mean(off))


def cases(only: str) -> Iterator[tuple[str, str, str]]:
    """Who, how, and where."""
    spots = list(places(PERSON_PICTURE_SIZE))
    for number, (who, how) in enumerate((who, how) for who in RIGGED_PEOPLE for how in POSES):
        if only in f"{who}: {how}":
            yield who, how, spots[number % len(spots)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="WORD")
    parser.add_argument("--clip", default="walk", choices=sorted(CLIPS))
    parser.add_argument("--back", default="see_through", choices=get_args(BackTexture))
    parser.add_argument("--surface", default="relief", choices=("relief", "shell", "hybrid"))
    parser.add_argument("--sheet", type=Path)
    asked = parser.parse_args()
    print(machine())
    spots = places(PERSON_PICTURE_SIZE)
    rows: list[list[str]] = []
    templates: list[list[str]] = []
    counted: list[list[float | None]] = []
    bare: list[list[float | None]] = []
    sheet: list[Row] = []
    for who, how, where in cases(asked.only):
        truth = Player(*_with_clip(read_rigged(who, media("scans3d")), asked.clip))
        mesh, pose = truth.mesh, held_pose(truth.mesh.skeleton, POSES[how])
        vertices = truth.held(pose).astype(np.float64)
        vertices[:, 1] -= vertices[:, 1].min()
        person = Person(
            f"{who}: {how}",
            vertices,
            mesh.triangles,
            T_POSE_HEIGHT_METRES,
            texture_painter(mesh.uv, mesh.triangles, [mesh.texture], [len(mesh.triangles)]),
        )
        picture = draw_into(person, spots[where])
        with tempfile.TemporaryDirectory() as folder:
            photo = Path(folder) / "photo.png"
            Image.fromarray(picture.rgb).save(photo)
            try:
                woken = wake(photo, {"back_texture": asked.back, "surface": asked.surface})
            except InputError as error:
                rows.append([person.name, error.code, *[""] * len(COLUMN_TITLES)])
                continue
        transforms = pose_transforms(mesh.skeleton, pose.rotations, pose.root)[0]
        joints = np.einsum("jab,jb->ja", transforms[:, :3, :3], mesh.skeleton.heads) + transforms[:, :3, 3]
        off = limbs_off(joints.astype(np.float32), mesh, woken)
        made = Player(*_with_clip(woken.character.mesh, asked.clip))
        plain = Player(*_with_clip(template_of(woken), asked.clip))
        of_it = play(truth, made, made.held(woken.character.pictured))
        of_template = play(truth, plain, plain.posed(0))
        for values, found in ((rows, of_it), (templates, of_template)):
            values.append(
                [person.name, f"{off:.1f}", *(f"{v:.{d}f}" for v, d in zip(found.row, COLUMN_DIGITS, strict=True))]
            )
        print(rows[-1], templates[-1], flush=True)
        if who in COUNTED_PEOPLE:
            counted.append([off, *of_it.row])
            bare.append([off, *of_template.row])
        sheet.append(_row(person.name, picture.rgb, (truth, made, plain)))
    digits = (1, *COLUMN_DIGITS)
    for title, values, means in (("Characters", rows, counted), ("Bare fitted template", templates, bare)):
        if means:
            values.append(mean_row("mean", means, digits))
        print(table(f"{title}, {asked.clip}, back: {asked.back}", ["", "posed", *COLUMN_TITLES], values))
    if asked.sheet:
        write_sheet(asked.sheet, contact_sheet(sheet))


def _with_clip(mesh: SkinnedMesh, clip: str) -> tuple[SkinnedMesh, Clip]:
    return mesh, built_in(clip, mesh.skeleton)


def _row(title: str, picture: NDArray[np.uint8], players: Sequence[Player]) -> Row:
    panels = [at_height(picture, VIEW_SIDE_PIXELS)]
    backdrop = np.full((VIEW_SIDE_PIXELS, VIEW_SIDE_PIXELS, 3), 150, np.uint8)
    for degrees, share in ((0, 0.1), (90, 0.4), (180, 0.7)):
        for one in players:
            drawn = draw_character(one.subject, one.posed(share), camera_at(degrees), backdrop)
            panels.append(drawn.rgb[:, VIEW_SIDE_PIXELS // 4 : -VIEW_SIDE_PIXELS // 4])
    return Row(panels, title)


if __name__ == "__main__":
    main()
