"""The avatar's mesh: the template's own parts, whole and closed, moved by its rig."""

import numpy as np
import pytest

from engine.avatar.eye_charts import avatar_uv
from engine.avatar.mesh import AVATAR_PARTS, Surface, morphs_of, skinned_mesh, surface_of
from engine.body.rest_pose import t_pose
from engine.body.rig import HUMAN_RIG
from engine.body.template import Template, load_rig, load_template
from engine.geometry.mesh.welding import is_closed
from engine.geometry.rigging.skinned_mesh import SkinnedMesh


@pytest.fixture(scope="module")
def template() -> Template:
    return load_template()


@pytest.fixture(scope="module")
def surface(template: Template) -> Surface:
    return surface_of(template)


@pytest.fixture(scope="module")
def mesh(template: Template, surface: Surface) -> SkinnedMesh:
    rig = load_rig(HUMAN_RIG)
    skeleton, _, vertices = t_pose(rig, template.vertices, template.vertices_of("body"))
    return skinned_mesh(surface, rig, skeleton, vertices, np.zeros((8, 8, 3), np.uint8))


def test_it_has_the_template_s_faces_as_two_triangles_each_and_no_others(template: Template, surface: Surface) -> None:
    assert len(surface.triangles) == 2 * len(template.faces(*AVATAR_PARTS))
    used = np.unique(surface.vertex_of[surface.triangles])
    assert np.array_equal(used, np.unique(template.quads[template.faces(*AVATAR_PARTS)]))


def test_each_corner_has_the_place_on_the_texture_that_avatars_give_it(template: Template, surface: Surface) -> None:
    places = avatar_uv(template)
    given = {
        (int(v), *np.round(places[u], 6).tolist())
        for v, u in zip(template.quads.ravel(), template.uv_quads.ravel(), strict=True)
    }
    for vertex, uv in zip(surface.vertex_of, surface.uv, strict=True):
        assert (int(vertex), *np.round(uv, 6).tolist()) in given


def test_welded_at_the_texture_s_seams_the_body_is_closed(template: Template, surface: Surface) -> None:
    corners = surface.vertex_of[surface.triangles]
    body = corners[np.isin(corners, template.vertices_of("body")).all(axis=1)]
    assert is_closed(body.astype(np.int32))


def test_it_stands_on_the_ground_and_is_moved_by_at_most_four_joints(mesh: SkinnedMesh) -> None:
    assert mesh.vertices[:, 1].min() == pytest.approx(0, abs=1e-5)
    assert mesh.bones.shape[1] == 4
    assert mesh.weights.sum(1) == pytest.approx(1, abs=1e-6)
    assert (np.diff(mesh.weights, axis=1) <= 1e-7).all()


def test_an_eye_follows_its_joint_alone(template: Template, surface: Surface, mesh: SkinnedMesh) -> None:
    eye = np.isin(surface.vertex_of, template.vertices_of("left_eye"))
    assert (mesh.bones[eye, 0] == mesh.skeleton.index("LeftEye")).all()
    assert mesh.weights[eye, 0] == pytest.approx(1, abs=1e-5)


def test_a_morph_target_moves_both_sides_of_a_seam_alike(template: Template, surface: Surface) -> None:
    moved = np.random.default_rng(3).normal(size=template.vertices.shape)
    (target,) = morphs_of(surface, {"shape": moved})
    assert target.dense(len(surface.vertex_of)) == pytest.approx(moved[surface.vertex_of].astype(np.float32))


def test_a_skeleton_of_other_joints_is_refused(template: Template, surface: Surface, mesh: SkinnedMesh) -> None:
    with pytest.raises(ValueError, match="other joints"):
        skinned_mesh(surface, load_rig("mixamo"), mesh.skeleton, template.vertices, mesh.texture)
