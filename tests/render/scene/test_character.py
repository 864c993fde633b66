"""Drawn characters against pictures whose every pixel is known, and the shadow they cast."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from template_character import template_character, walk

from engine.geometry.camera import Camera
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms
from engine.render.lighting.ground_shadow import SHADOW_CELL_METRES, GroundShadow, shadow_map
from engine.render.scene.backdrop import Backdrop
from engine.render.scene.camera_moves import camera_at
from engine.render.scene.character import (
    LIGHT_DIRECTION,
    SAMPLES_PER_AXIS,
    Actor,
    draw_character,
    film_cast,
    prepare_character,
)

ONE = Skeleton(("Hips",), np.array([-1], np.int32), np.zeros((1, 3), np.float32))
FLAT = Camera(eye=(0, 0, 2.0), focal=64, centre=(31.5, 31.5), size=(64, 64))
"""One metre at z = 0 is 32 pixels wide."""


def card(texture: np.ndarray, *places: tuple[float, float, float]) -> SkinnedMesh:
    """Upright squares of 2 m around the given centres, facing +z, each showing the whole texture."""
    corners = np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]], np.float32)
    count = len(places)
    return SkinnedMesh(
        ONE,
        np.concatenate([corners + np.array(place, np.float32) for place in places]).astype(np.float32),
        np.concatenate([np.array([[0, 2, 1], [0, 3, 2]]) + 4 * k for k in range(count)]).astype(np.int32),
        np.tile(np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32), (count, 1)),
        np.zeros((4 * count, 4), np.uint8),
        np.tile(np.array([1, 0, 0, 0], np.float32), (4 * count, 1)),
        texture,
    )


def noise(size: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 256, (size, size, 3), np.uint8)


def test_a_texture_seen_one_to_one_comes_back() -> None:
    texture = noise(64)
    mesh = card(texture, (0, 0, 0))
    drawn = draw_character(prepare_character(mesh), mesh.vertices, FLAT)
    assert (drawn.alpha == 1).all()
    off = np.abs(drawn.rgb.astype(int) - texture).max(2)
    assert off[~np.eye(64, dtype=bool)].max() <= 1  # a pixel on the diagonal is coloured twice, off its centre


def test_edges_are_as_opaque_as_they_are_covered() -> None:
    """The card's left edge lies 1/3 into the column 20, its upper edge 2/3 into the row 10."""
    mesh = card(noise(8), ((20 - 31.5 - 0.5 + 1 / 3) / 32 + 1, (31.5 - 10 + 0.5 - 2 / 3) / 32 - 1, 0))
    background = noise(64, 1)
    drawn = draw_character(prepare_character(mesh), mesh.vertices, FLAT, background)
    assert drawn.alpha[40, 20] == pytest.approx(2 / 3, abs=0.35 / SAMPLES_PER_AXIS)
    assert drawn.alpha[10, 40] == pytest.approx(1 / 3, abs=0.35 / SAMPLES_PER_AXIS)
    assert not drawn.alpha[:, :20].any() and not drawn.alpha[:10].any() and (drawn.alpha[11:, 21:] == 1).all()
    np.testing.assert_array_equal(drawn.rgb[drawn.alpha == 0], background[drawn.alpha == 0])
    alone = draw_character(prepare_character(mesh), mesh.vertices, FLAT)
    np.testing.assert_array_equal(alone.alpha, drawn.alpha)
    mixed = alone.alpha[..., None] * alone.rgb + (1 - alone.alpha[..., None]) * background
    assert np.abs(mixed - drawn.rgb).max() <= 1.01


def test_the_nearer_card_hides_the_other() -> None:
    texture = np.full((16, 16, 3), 200, np.uint8)
    texture[:8] = 50
    far_then_near = card(texture, (0, 0, -1), (0, 0.5, 0.5))
    near_then_far = card(texture, (0, 0.5, 0.5), (0, 0, -1))
    first, second = (
        draw_character(prepare_character(mesh), mesh.vertices, FLAT).rgb for mesh in (far_then_near, near_then_far)
    )
    np.testing.assert_array_equal(first, second)


def test_where_two_surfaces_pass_through_each_other_a_pixel_shows_both() -> None:
    """A slanted card comes out of an upright one a third into the column 20."""
    texture = np.full((64, 64, 3), 50, np.uint8)
    texture[:, 32:] = 200
    mesh = card(texture, (0, 0, 0), (0, 0, 0))
    line = (20 - 31.5 - 0.5 + 1 / 3) / 32
    mesh.vertices[4:, 2] = np.where(mesh.vertices[4:, 0] < 0, -0.1, 0.1) - 0.1 * line
    mesh.uv[:4, 0] = 0.25
    mesh.uv[4:, 0] = 0.75
    row = draw_character(prepare_character(mesh), mesh.vertices, FLAT).rgb[32, :, 0]
    assert (row[:20] == 50).all() and (row[22:60] == 200).all()
    assert row[20] == pytest.approx(50 + 150 * 2 / 3, abs=150 / 2 / SAMPLES_PER_AXIS)


def test_a_fine_pattern_far_away_is_its_mean() -> None:
    y, x = np.mgrid[:512, :512]
    texture = np.where((x + y)[..., None] % 2, 255, 0).repeat(3, 2).astype(np.uint8)
    mesh = card(texture, (0, 0, 0))
    drawn = draw_character(prepare_character(mesh), mesh.vertices, FLAT)
    assert np.abs(drawn.rgb.astype(int) - 127).max() <= 2


def test_an_open_surface_has_two_sides_and_a_closed_ones_backs_cover_nothing_new() -> None:
    mesh = card(noise(8), (0, 0, 0))
    behind = Camera((0, 0, 0), 64, (31.5, 31.5), (64, 64)).aimed((0, 0, -2), (0, 0, 0))
    assert not prepare_character(mesh).closed
    assert (draw_character(prepare_character(mesh), mesh.vertices, behind).alpha[4:60, 4:60] == 1).all()
    body = template_character(texture_size=64)
    subject, clip = prepare_character(body), walk(body.skeleton, 4)
    assert subject.closed
    bent = clip.rotations.copy()
    bent[:, body.skeleton.index("LeftForeArm")] = [0, -0.98, 0, 0.2]  # folded into itself
    transforms = pose_transforms(body.skeleton, bent, clip.root)[1]
    posed = skin(body.vertices, body.bones, body.weights, transforms)
    camera = Camera((0, 0, 0), 300, (149.5, 199.5), (400, 300)).aimed((1.0, 1.2, 2.0), (0, 0.9, 0.3))
    both = draw_character(replace(subject, closed=False), posed, camera)
    np.testing.assert_array_equal(draw_character(subject, posed, camera).alpha, both.alpha)


def test_shading_is_none_towards_the_light_and_full_away_from_it() -> None:
    mesh = card(np.full((8, 8, 3), 200, np.uint8), (0, 0, 0))
    towards = np.array(LIGHT_DIRECTION) / np.linalg.norm(LIGHT_DIRECTION)
    for away, expected in ((1, 200), (-1, 100)):
        camera = Camera((0, 0, 0), 64, (31.5, 31.5), (64, 64)).aimed(3 * away * towards, (0, 0, 0))
        right, up, _ = np.array(camera.axes)
        posed = (mesh.vertices[:, :1] * right + mesh.vertices[:, 1:2] * up).astype(np.float32)
        drawn = draw_character(prepare_character(mesh), posed, camera, shading=0.5)
        assert drawn.alpha[32, 32] == 1 and abs(int(drawn.rgb[32, 32, 0]) - expected) <= 1


def test_nothing_in_view_leaves_the_background() -> None:
    background = noise(64)
    for place in ((9.0, 0.0, 0.0), (0.0, 0.0, 5.0)):
        mesh = card(noise(8), place)
        drawn = draw_character(prepare_character(mesh), mesh.vertices, FLAT, background)
        np.testing.assert_array_equal(drawn.rgb, background)
        assert not drawn.alpha.any()
    with pytest.raises(ValueError, match="background"):
        draw_character(prepare_character(mesh), mesh.vertices, FLAT, background[1:])


def test_the_shadow_is_dark_under_what_touches_the_ground_and_fades_with_height() -> None:
    lying = np.array([[-0.5, 0, -0.5], [0.5, 0, -0.5], [0.5, 0, 0.5], [-0.5, 0, 0.5]], np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    densities = []
    for height in (0.0, 0.2, 1.0):
        density, corner = shadow_map(lying + np.array([0, height, 0], np.float32), faces, GroundShadow())
        middle = ((0 - corner) / SHADOW_CELL_METRES).astype(int)
        densities.append(density[middle[1], middle[0]])
        assert density[0].max() < 0.02 and density[:, -1].max() < 0.02
    assert densities[0] > 0.95 and densities[0] > densities[1] > densities[2]


def test_a_slanted_light_throws_the_shadow_the_other_way() -> None:
    """Light from the left at 45 degrees: a card 1 m up throws its shadow 1 m to the right."""
    lying = np.array([[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]], np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    light = GroundShadow(reach=np.inf, light=(-1.0, 1.0, 0.0))
    density, corner = shadow_map(lying, faces, light)
    rows, columns = np.mgrid[: density.shape[0], : density.shape[1]]
    place = [
        (density * index).sum() / density.sum() * SHADOW_CELL_METRES + SHADOW_CELL_METRES / 2
        for index in (columns, rows)
    ]
    np.testing.assert_allclose(corner + place, [1, 0], atol=0.01)


def test_the_shadow_falls_where_the_camera_sees_the_ground_under_the_feet() -> None:
    lying = np.array([[-0.2, 0, -0.2], [0.2, 0, -0.2], [0.2, 0, 0.2], [-0.2, 0, 0.2]], np.float32)
    mesh = card(noise(8), (0, 0, 0))
    mesh = SkinnedMesh(**{**vars(mesh), "vertices": lying + np.array([0, 1.9, 0], np.float32)})
    camera = Camera(eye=(0, 1.6, 0), focal=150, centre=(99.5, 74.5), size=(150, 200)).aimed((1, 1.6, 2), (0, 0.4, 0))
    background = np.full((150, 200, 3), 200, np.uint8)
    shadow = GroundShadow(strength=0.5, reach=np.inf)
    drawn = draw_character(prepare_character(mesh), mesh.vertices, camera, background, shadow)
    x, y = camera.project(np.zeros((1, 3)))[0, :2].round().astype(int)
    dark = 200 - drawn.rgb[..., 0].astype(float)
    assert dark[y, x] > 0.9 * dark.max() > 20
    assert not dark[: y - 60].any()
    # half as dark is the shadow's edge: the square itself, projected
    square = np.zeros((150, 200), np.uint8)
    cv2.fillConvexPoly(square, camera.project(lying)[:, :2].round().astype(np.int32), 1)
    edge = dark > dark.max() / 2
    assert (edge & (square > 0)).sum() / (edge | (square > 0)).sum() > 0.8


def test_a_film_is_its_frames_in_order() -> None:
    mesh = template_character(texture_size=64)
    clip = walk(mesh.skeleton, 7)
    subject = prepare_character(mesh)
    camera = Camera((0, 0, 0), 120, (59.5, 79.5), (160, 120)).aimed((0, 1.0, 3.0), (0, 0.85, 0))
    plate = np.random.default_rng(2).integers(0, 256, (160, 120, 3), np.uint8)
    stage = Backdrop(plate, camera, 6.0)
    film = list(
        film_cast(
            [Actor(subject, clip)],
            lambda s: camera_at("orbit", camera, (0, 0.8, 0), s),
            stage.seen_by,
            GroundShadow(),
        )
    )
    assert len(film) == 7
    for frame in (0, 5):
        moved = camera_at("orbit", camera, (0, 0.8, 0), frame / clip.fps)
        transforms = pose_transforms(mesh.skeleton, clip.rotations[[frame]], clip.root[[frame]])[0]
        posed = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
        alone = draw_character(subject, posed, moved, stage.seen_by(moved), GroundShadow())
        np.testing.assert_array_equal(film[frame], alone.rgb)


def test_a_shape_that_changes_is_drawn_as_it_is_in_each_frame() -> None:
    mesh = template_character(texture_size=64)
    loop = walk(mesh.skeleton, frames=2, travels=False)
    camera = Camera((0.0, 0.9, 4.0), 120.0, (31.5, 47.5), (96, 64))
    shapes = [mesh.vertices, (mesh.vertices * np.float32([1, 0.8, 1])).astype(np.float32)]
    subject = prepare_character(mesh)

    def drawn(actor: Actor) -> list[np.ndarray]:
        return list(film_cast([actor], lambda second: camera, lambda camera: np.zeros((96, 64, 3), np.uint8)))

    changing = drawn(Actor(subject, loop, rest_at=shapes.__getitem__))
    for frame, shape in enumerate(shapes):
        alone = drawn(Actor(prepare_character(replace(mesh, vertices=shape)), loop))
        np.testing.assert_array_equal(changing[frame], alone[frame])


def test_a_clip_of_one_frame_gives_one() -> None:
    mesh = card(noise(8), (0, 0, 0))
    clip = Clip("still", 30, np.array([[[0, 0, 0, 1]]], np.float32), np.zeros((1, 3), np.float32))
    empty = np.zeros((64, 64, 3), np.uint8)
    (drawn,) = film_cast([Actor(prepare_character(mesh), clip)], lambda second: FLAT, lambda camera: empty)
    np.testing.assert_array_equal(drawn, draw_character(prepare_character(mesh), mesh.vertices, FLAT).rgb)


def test_who_is_nearer_stands_before_the_others() -> None:
    """Two squares in one place of the picture, each in a world of its own: the later of the cast is seen."""
    clip = Clip("still", 30, np.array([[[0, 0, 0, 1]]], np.float32), np.zeros((1, 3), np.float32))
    cards = []
    for grey in (50, 200):
        cards.append(prepare_character(card(np.full((8, 8, 3), grey, np.uint8), (0, 0, 0))))
    empty = np.zeros((64, 64, 3), np.uint8)
    cast = [Actor(cards[0], clip), Actor(cards[1], clip, (0.5, 0.0, 0.2))]
    (drawn,) = film_cast(cast, lambda second: FLAT, lambda camera: empty)
    assert (drawn[32, 8] == 50).all()
    assert (drawn[32, 50] == 200).all()


def test_no_shadow_falls_on_somebody_and_where_two_meet_the_darker_stays() -> None:
    """A card hangs out of view, later in the cast: its shadow lies on the ground behind an upright one, and beside it."""
    clip = Clip("still", 30, np.array([[[0, 0, 0, 1]]], np.float32), np.zeros((1, 3), np.float32))
    upright = card(np.full((8, 8, 3), 200, np.uint8), (0, 1, 0))
    hanging = replace(upright, vertices=np.ascontiguousarray(upright.vertices[:, [0, 2, 1]] + np.float32([4, 9, 3.5])))
    camera = Camera((0, 0, 0), 120, (59.5, 79.5), (160, 120)).aimed((0, 2.5, 5.0), (0, 0.8, 0))
    ground = np.full((160, 120, 3), 180, np.uint8)
    sun = GroundShadow(reach=np.inf, light=(0.5, 1.0, 0.5))

    def filmed(*cast: SkinnedMesh) -> np.ndarray:
        actors = [Actor(prepare_character(mesh), clip) for mesh in cast]
        return next(film_cast(actors, lambda second: camera, lambda camera: ground, sun))

    first, second, both = filmed(upright), filmed(hanging), filmed(upright, hanging)
    covered = draw_character(prepare_character(upright), upright.vertices, camera).alpha
    behind = (covered == 1) & (second[..., 0] < 150)
    assert behind.sum() > 100
    assert (both[behind] == 200).all()
    bare = covered == 0
    np.testing.assert_array_equal(both[bare], np.minimum(first, second)[bare])
    assert (bare & (first[..., 0] < 150) & (second[..., 0] < 150)).sum() > 20
