"""Where drawn surfaces are looked at closely, and what is found there, against pictures drawn sample by sample."""

import numpy as np
import pytest
from template_character import template_character, walk

from engine.geometry.camera import Camera
from engine.geometry.mesh.adjacency import edge_table
from engine.geometry.mesh.welding import weld
from engine.geometry.rigging.skinning import skin
from engine.motion.kinematics import pose_transforms
from engine.render.rasterisation.multisampling import draw_samples, sample_offsets, select_pixels
from engine.render.rasterisation.outline import facings, mark_outline
from engine.render.rasterisation.rasteriser import SUBPIXEL_STEPS, draw_into, rasterise

EVERYWHERE = select_pixels(np.ones((48, 64), np.bool_))


@pytest.mark.parametrize("samples", [1, 2, 3, 4])
@pytest.mark.parametrize("cull", [False, True])
def test_a_sample_sees_what_the_centre_of_a_shifted_picture_sees(samples: int, cull: bool) -> None:
    rng = np.random.default_rng(samples)
    points = rng.uniform((-20, -20, 1), (84, 68, 9), (150, 3)).astype(np.float32)
    points[:, :2] = np.round(points[:, :2] * SUBPIXEL_STEPS) / SUBPIXEL_STEPS
    faces = np.arange(150, dtype=np.int32).reshape(-1, 3)
    offsets = sample_offsets(samples)
    assert len(offsets) == samples**2 and np.abs(offsets.sum(0)).max() == 0
    seen = draw_samples(points, faces, facings(points, faces), cull, *EVERYWHERE, offsets)
    rows, columns = EVERYWHERE.places.T
    for k, (dx, dy) in enumerate(offsets / SUBPIXEL_STEPS):
        shifted = points - np.array([dx, dy, 0], np.float32)
        expected = rasterise(shifted, faces, (48, 64), perspective=True, cull=cull).triangle
        assert (seen[:, k] == expected[rows, columns]).mean() > 0.999  # depths alike within rounding


def test_only_chosen_pixels_are_looked_at_and_each_as_among_all() -> None:
    rng = np.random.default_rng(3)
    points = rng.uniform((-20, -20, 1), (84, 68, 9), (150, 3)).astype(np.float32)
    faces = np.arange(150, dtype=np.int32).reshape(-1, 3)
    marks = rng.random((48, 64)) < 0.05
    facing, offsets = facings(points, faces), sample_offsets(3)
    every = draw_samples(points, faces, facing, False, *EVERYWHERE, offsets)
    chosen = select_pixels(marks)
    assert sorted(map(tuple, chosen.places.tolist())) == list(zip(*np.nonzero(marks), strict=True))
    some = draw_samples(points, faces, facing, False, *chosen, offsets)
    np.testing.assert_array_equal(some, every[marks[tuple(EVERYWHERE.places.T)]])


def test_every_pixel_that_a_figure_covers_in_part_is_on_its_outline_and_few_others_are() -> None:
    """The limbs pass before the body, so that parts of the outline are hidden, and others lie within the figure."""
    body = template_character(texture_size=64)
    clip = walk(body.skeleton, 8)
    edges, faces = edge_table(body.triangles, weld(body)), body.triangles
    camera = Camera((0, 0, 0), 300, (149.5, 199.5), (400, 300)).aimed((1.6, 1.2, 1.6), (0, 0.9, 0.3))
    for transforms in pose_transforms(body.skeleton, clip.rotations, clip.root)[::3]:
        points = camera.project(skin(body.vertices, body.bones, body.weights, transforms))
        ids, depths = np.full(camera.size, -1, np.int32), np.full(camera.size, np.inf, np.float32)
        draw_into(points, faces, True, True, ids, depths)
        marks = np.zeros(camera.size, np.bool_)
        facing = facings(points, faces)
        mark_outline(points, edges, facing, depths, marks)
        every = select_pixels(np.ones(camera.size, np.bool_))
        order = np.lexsort(every.places.T[::-1])
        seen = draw_samples(points, faces, facing, True, *every, sample_offsets(3))[order].reshape(400, 300, 9)
        covered = (seen >= 0).sum(-1)
        np.testing.assert_array_equal(seen[..., 4], ids)
        assert not ((covered > 0) & (covered < 9) & ~marks).any()
        assert marks.sum() < 0.35 * (covered > 0).sum()
