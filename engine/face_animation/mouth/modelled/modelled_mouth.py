"""The inside of a mouth that no photograph shows as it moves: lower teeth, tongue and the dark, modelled."""

from __future__ import annotations

from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_contours import box_around, inner_lip_outline, soft_polygon
from engine.face_animation.mouth.modelled.jaw import Jaw, held_between, jaw_of
from engine.face_animation.mouth.modelled.mouth_colours import COLOUR_RAMP_PIXELS, MouthColours
from engine.face_animation.mouth.modelled.mouth_light import mouth_light
from engine.face_animation.mouth.modelled.mouth_parts import (
    OVERBITE_EYE_DISTANCES,
    OVERJET_EYE_DISTANCES,
    TONGUE_JAW_SHARE,
    bag_surface,
    modelled_teeth,
    mouth_bag,
    tongue,
)
from engine.face_animation.mouth.modelled.resting_mouth import RestingMouth
from engine.face_animation.mouth.modelled.skull import from_before, skull_camera
from engine.face_animation.smoothstep import smoothstep
from engine.geometry.mesh.adjacency import edge_table
from engine.geometry.mesh.surface import vertex_normals
from engine.perception.face.landmarks import (
    INNER_LOWER_LIP_VERTEX,
    INNER_MOUTH_CORNER_VERTICES,
    INNER_UPPER_LIP_VERTEX,
    LIPS_INNER,
    eye_distance,
    mouth_opening,
)
from engine.render.scene.scratch import Scratch
from engine.render.scene.surface import Surface, draw_surface, triangle_spread
from engine.render.textures.mipmap import build_mipmap

LIP_SOFTNESS_EYE_DISTANCES, MIN_LIP_SOFTNESS_PIXELS = 0.012, 0.8
"""Eye distances, and pixels, over which the inside passes into the lips: their edges are round, and the mesh's have corners."""
AMBIENT_LIGHT_SHARE, TEETH_AMBIENT_LIGHT_SHARE = 0.8, 0.5
"""Of the light on a surface, that it has wherever it faces: a tongue is round by it; and on teeth, whose crowns are told apart by it."""
TEETH_FALLOFF_EYE_DISTANCES = 0.35
"""Eye distances behind the upper teeth at which a third of the light is left on teeth: cheeks are beside them. Ramps of the other parts have theirs."""
LIT_GAP_EYE_DISTANCES, MIN_INSIDE_LIGHT_SHARE = (0.05, 0.4), 0.35
"""Eye distances between the lips up to which hardly any light falls on the tongue and what is around it, and from which on all; and what is left of it. Teeth are
before it: a tongue as light behind lips that hardly part is a plug."""
INCISORS_SHARE = 0.25
"""Of the teeth, which are the foremost."""
LIGHTEST_PERCENTILE = 80
"""Of the light on incisors, that which their colours are of."""
ABOVE_LIP_EYE_DISTANCES, BELOW_LIP_EYE_DISTANCES = 0.03, 0.05
"""Eye distances above and below the lower lip's inner edge between which lower teeth end. A face may open its mouth
farther or less far than its chin tells. Then they go along, and neither stand in the middle of a mouth nor leave it
empty."""
BARING_JAW_RADIANS = (0.12, 0.28)
"""Radians of the jaw up to which the lower lip hides the lower teeth, as it does when people smile, and from which on it lets them be seen."""
BAG_DEPTH_FACTOR = 2.5
"""The bag than in the model: a tongue lies in it wherever the jaw is."""
DEPTH_SHARE = 0.45
"""Share of depths behind the upper teeth by which things are seen higher or lower. How far a head is bent forward or
back is known to some degrees only, and in true depth these decide whether a tongue is seen at all. To the sides they
count wholly: rows of teeth turn with the lips."""
MAX_CROWN_EYE_DISTANCES = (0.08, 0.17)
"""Eye distances of the upper row that are seen below the middle of the upper lip, at most: of a mouth that opens without smiling, as at rest and a little more, since
the lip is stretched down over its teeth; and of one that smiles, a whole crown. Where a lip is drawn up farther than its person's would be, the row goes along."""
SMILING_WIDTH_SHARES = (1.0, 1.15)
"""Widths of a mouth, in its width at rest, up to which it does not smile, and from which on it does."""
ROUNDED_NARROWING_SHARE, ROUNDED_CROWN_EYE_DISTANCES = 0.05, 0.6
"""Share of its width by which a mouth is narrower than at rest from which on its lips are rounded, and eye distances of
the upper row that they cover for all of it. Lips that say O are pushed forward over the teeth, though their edges are
as high as in a smile."""
STUB_EYE_DISTANCES = (0.035, 0.06)
"""Eye distances of the upper row that would be seen below the upper lip, up to which it covers all of them, and from which on none, as at rest: of
crowns that end just below it only stubs are left."""
COVERED_ROW_EYE_DISTANCES = 0.04
"""Eye distances by which a row that is covered ends above the lip's middle: the lip is higher beside it, and soft."""
APPEARING_OPENING_RANGE = 0.03
"""By how much a mouth opens while its inside appears, slowly at first: a tracker has closed lips up to 0.024 apart for a frame."""
CAMERA_DISTANCE_PIXELS = 4096.0
"""Pixels from the eye: so far off that nearer parts are no larger."""
AFFINE_FRAME = np.concatenate([np.zeros((1, 3)), np.eye(3)])
"""What a part's places follow from, since each part moves as a whole: the origin, and a step along each axis."""
SAMPLES_PER_PIXEL = 2
"""To a pixel, along each axis, where outlines run: the inside is softened by the lips around it."""
ALL_TEETH = (1.0, 1.0)
"""Shares of the opening that upper and lower teeth may fill of whom it is not known what they show."""
MAX_CLOSED_OPENING = 0.01
"""Opening of a mouth of which nothing is seen."""


class ModelledMouth:
    """`MouthInterior` of a person: what is modelled, in their `colours`, behind the lips of a face that rests as `at` says. `upper` :
    whether upper teeth are modelled, too. `appearing` : the opening from which on it is seen. `softness` : eye distances, the blur of its edges
    (`picture_softness`). `shown` : (N, 2) what share of the opening the teeth of each driver frame fill (`seen_teeth`); no more is seen of these."""

    def __init__(
        self,
        at: RestingMouth,
        colours: MouthColours,
        upper: bool,
        appearing: float = 0.0,
        softness: float = 0.0,
        shown: NDArray[np.floating] | None = None,
    ):
        self._shown = shown
        self._at, self._appearing, self._softness, self._albedo = at, appearing, softness, colours.albedo
        rows = [(modelled_teeth(at, True), colours.upper)] if upper else []
        jaw = [(modelled_teeth(at, False), colours.lower), (tongue(at), colours.tongue)]
        parts = [*rows, *jaw]
        upper_end = sum(len(part.vertices) for part, _ in rows)
        self._ends = [upper_end, upper_end + len(jaw[0][0].vertices)]
        self._vertices = np.concatenate([part.vertices for part, _ in parts])
        self._light = np.concatenate([part.light for part, _ in parts])
        self._textures = [*(ramp for _, ramp in parts), colours.bag]
        bag, bag_uv = bag_surface()
        uvs = [*(part.uv for part, _ in parts), bag_uv]
        starts = np.cumsum([0, *(len(uv) for uv in uvs)])
        triangles = [
            one + start for one, start in zip((*(part.triangles for part, _ in parts), bag), starts, strict=False)
        ]
        self._triangles = np.concatenate(triangles).astype(np.int32)
        self._uv = np.concatenate([_on_atlas(uv, number, len(uvs)) for number, uv in enumerate(uvs)])
        self._bag_vertices = len(bag_uv)

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], driver_frame: int) -> None:
        """As `MouthInterior.draw`."""
        inner = inner_lip_outline(face)
        box = box_around(inner, frame.shape[:2])
        share = shown_share(face, self._appearing)
        if box is None or share == 0 or float(mouth_opening(face)) < MAX_CLOSED_OPENING or cv2.contourArea(inner) < 1:
            return
        x0, y0, x1, y1 = box
        shape, corner = (y1 - y0, x1 - x0), np.array([x0, y0], np.float32)
        points = self.places(face, shown_teeth(self._shown, driver_frame)) - (x0, y0, 0)
        inside = np.zeros((*shape, 3), np.uint8)
        inside[:] = self._textures[-1][COLOUR_RAMP_PIXELS[1] // 2, -1]  # the dark
        unit = float(eye_distance(face))
        shade = self._shade.copy()
        shade[self._ends[1] :] *= inside_light(face)
        draw_surface(inside, False, self._surface, points.astype(np.float32), Scratch(), SAMPLES_PER_PIXEL, shade)
        if self._softness > 0:
            inside = np.asarray(cv2.GaussianBlur(inside, (0, 0), self._softness * unit))
        lit = inside * mouth_light(face, corner, shape, self._albedo)
        sigma = max(MIN_LIP_SOFTNESS_PIXELS, max(LIP_SOFTNESS_EYE_DISTANCES, self._softness) * unit)
        mask = cv2.GaussianBlur(soft_polygon(inner - corner, shape), (0, 0), sigma)[..., None]
        part = frame[y0:y1, x0:x1]
        part[:] = np.clip(part + share * np.asarray(mask) * (lit - part) + 0.5, 0, 255).astype(np.uint8)

    def places(self, face: NDArray[np.floating], shown: tuple[float, float] = ALL_TEETH) -> NDArray[np.float64]:
        """(V, 3) where all vertices are, pixels of the picture of a `face` (478, 2), and how far away. `shown` : shares of the opening that upper and lower
        teeth fill at most."""
        matrix, shift = skull_camera(self._at.front, face)
        scale = float(np.linalg.norm(matrix[0]))
        camera = np.vstack([matrix, np.cross(matrix[0], matrix[1]) / scale])
        depths = self._at.front[:, 2]
        front = from_before(self._at.front, face, matrix, shift)
        jaw = jaw_behind_lips(self._at, front, shown[1])
        lips = np.column_stack([front, depths])[list(LIPS_INNER)]
        tongue_jaw = jaw._replace(angle=TONGUE_JAW_SHARE * jaw.angle)
        lip = float(front[INNER_UPPER_LIP_VERTEX, 1])
        raised = min(lip + most_crown(self._at, front) - self._at.edge, 0.0) - covered_crown(self._at, front)
        raised -= hidden_crown(self._at.edge + raised - lip, front, shown[0])
        raised -= stubs(float(self._at.edge + raised - lip))
        bag = mouth_bag(lips, BAG_DEPTH_FACTOR, self._at.width)
        moved = np.concatenate(
            [AFFINE_FRAME + np.array([0, raised, 0]), jaw.moved(AFFINE_FRAME), tongue_jaw.moved(AFFINE_FRAME), bag]
        )
        behind = moved[:, 2:] - self._at.depth
        at_rest = (
            np.concatenate([AFFINE_FRAME, AFFINE_FRAME, AFFINE_FRAME, bag])[:, 2:] - self._at.depth
        )  # as deep as the lips are known
        aside = (camera[:2, 2] @ camera[:2, 0]) / scale**2 * camera[:2, 0]  # how depth is seen along the face's width
        places = moved @ camera.T
        places[:, :2] += (
            shift - behind * camera[:2, 2] + DEPTH_SHARE * behind * (camera[:2, 2] - aside) + at_rest * aside
        )
        places[:, 2] += CAMERA_DISTANCE_PIXELS
        parts = np.split(self._vertices, self._ends)
        frames = places[: len(parts) * len(AFFINE_FRAME)].reshape(len(parts), *AFFINE_FRAME.shape)
        seen = [part @ (four[1:] - four[0]) + four[0] for part, four in zip(parts, frames, strict=True)]
        return np.concatenate([*seen, places[-len(bag) :]])

    @cached_property
    def _surface(self) -> Surface:
        atlas = np.concatenate(self._textures)
        edges = edge_table(self._triangles, np.arange(len(self._uv), dtype=np.int32))
        spread = triangle_spread(self._triangles, self._uv, atlas.shape)
        return Surface(self._triangles, self._uv, spread, edges, False, build_mipmap(atlas, min(atlas.shape[:2])))

    @cached_property
    def _shade(self) -> NDArray[np.float32]:
        """(V,) the light that is left: less on what faces aside, and in the depth; the lightest places of incisors have the light that their colours are of."""
        vertices = np.concatenate([self._vertices, np.zeros((self._bag_vertices, 3))])
        normals = vertex_normals(vertices, self._triangles)
        teeth = np.arange(len(vertices)) < self._ends[1]
        ambient = np.where(teeth, TEETH_AMBIENT_LIGHT_SHARE, AMBIENT_LIGHT_SHARE)
        facing = ambient + (1 - ambient) * np.clip(-normals[:, 2], 0, 1)
        deep = np.exp(-np.maximum(vertices[:, 2] - self._at.depth, 0) / TEETH_FALLOFF_EYE_DISTANCES)
        shade = np.where(teeth, facing * deep, facing)
        shade[: len(self._light)] *= self._light
        row = slice(0, self._ends[1])
        before = vertices[row, 2] <= np.quantile(vertices[row, 2], INCISORS_SHARE)
        shade[row] = np.minimum(shade[row] / np.percentile(shade[row][before], LIGHTEST_PERCENTILE), 1)
        shade[len(self._vertices) :] = 1  # its ramp has its light
        return np.asarray(shade, np.float32)


def jaw_behind_lips(at: RestingMouth, front: NDArray[np.floating], shown: float = 1.0) -> Jaw:
    """The jaw of a face that rests as `at` says and is `front` (478, 2 or 3) from the front: as its chin tells, and where its lower lip is. Lower teeth fill no
    more than the share `shown` of the opening."""
    edge = np.array([at.middle, at.edge - OVERBITE_EYE_DISTANCES, at.depth + OVERJET_EYE_DISTANCES])
    lip, jaw = float(front[INNER_LOWER_LIP_VERTEX, 1]), jaw_of(front, at.shut)
    bared = float(np.interp(jaw.angle, BARING_JAW_RADIANS, (0, 1)))
    above = min(bared * ABOVE_LIP_EYE_DISTANCES, shown * _gap(front))
    lip += covered_crown(at, front)  # rounded lips are before the lower teeth, too
    return held_between(jaw, edge, (lip - above, lip + BELOW_LIP_EYE_DISTANCES))


def hidden_crown(seen: float, front: NDArray[np.floating], shown: float) -> float:
    """Eye distances by which the upper row, of which so many would be `seen` below the lip of a face `front` (478, 2 or 3) from the front, is higher than that
    for filling no more than the share `shown` of the opening. Where that is all of it, what is longer is behind the lower lip."""
    return max(seen - shown * _gap(front), 0.0) if shown < ALL_TEETH[0] else 0.0


def shown_teeth(shown: NDArray[np.floating] | None, frame: int) -> tuple[float, float]:
    """The shares of the opening that upper and lower teeth fill at most in a driver's `frame`, where they are `shown` (N, 2)."""
    return ALL_TEETH if shown is None else (float(shown[frame, 0]), float(shown[frame, 1]))


def covered_crown(at: RestingMouth, front: NDArray[np.floating]) -> float:
    """Eye distances of the upper row that the lips of a face that rests as `at` says and is `front` (478, 2 or 3) from the front cover, being rounded."""
    return ROUNDED_CROWN_EYE_DISTANCES * max(1 - _width_share(at, front) - ROUNDED_NARROWING_SHARE, 0.0)


def most_crown(at: RestingMouth, front: NDArray[np.floating]) -> float:
    """Eye distances of the upper row that are seen at most below the lip of a face that rests as `at` says and is `front` (478, 2 or 3) from the front."""
    opened, smiling = MAX_CROWN_EYE_DISTANCES
    return opened + (smiling - opened) * float(smoothstep(_width_share(at, front), *SMILING_WIDTH_SHARES))


def _gap(front: NDArray[np.floating]) -> float:
    """Between the lips of a face `front` (478, 2 or 3) from the front, in their middle."""
    return max(float(front[INNER_LOWER_LIP_VERTEX, 1] - front[INNER_UPPER_LIP_VERTEX, 1]), 0.0)


def _width_share(at: RestingMouth, front: NDArray[np.floating]) -> float:
    """The width of the mouth of a face `front` (478, 2 or 3), in its width at rest."""
    right, left = front[list(INNER_MOUTH_CORNER_VERTICES), :2]
    return float(np.linalg.norm(left - right)) / max(at.width, 1e-6)


def stubs(seen: float) -> float:
    """Eye distances by which the upper row, of which so many would be `seen` below the lip, is higher for not to be seen as stubs."""
    return (max(seen, 0.0) + COVERED_ROW_EYE_DISTANCES) * (1 - float(smoothstep(seen, *STUB_EYE_DISTANCES)))


def inside_light(face: NDArray[np.floating]) -> float:
    """The share of the light that falls on what is behind the teeth of a face (478, 2): more where its lips are further apart."""
    gap = float(np.linalg.norm(face[INNER_LOWER_LIP_VERTEX, :2] - face[INNER_UPPER_LIP_VERTEX, :2]))
    lit = float(smoothstep(gap / float(eye_distance(face)), *LIT_GAP_EYE_DISTANCES))
    return MIN_INSIDE_LIGHT_SHARE + (1 - MIN_INSIDE_LIGHT_SHARE) * lit


def shown_share(face: NDArray[np.floating], appearing: float) -> float:
    """How much of the inside of a mouth is seen of a face (478, 2), from an opening of `appearing` on; all of it always where that is zero."""
    if appearing == 0:
        return 1.0
    return float(smoothstep(float(mouth_opening(face)), appearing, appearing + APPEARING_OPENING_RANGE))


def _on_atlas(uv: NDArray[np.float32], number: int, count: int) -> NDArray[np.float32]:
    """Places on the `number`-th of `count` ramps that lie below one another, half a pixel off their edges."""
    inset = np.array([0.5 / COLOUR_RAMP_PIXELS[0], 0.5 / COLOUR_RAMP_PIXELS[1]])
    held = inset + uv * (1 - 2 * inset)
    held[:, 1] = (held[:, 1] + number) / count
    return held.astype(np.float32)
