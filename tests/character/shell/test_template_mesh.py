"""The mesh of which shells are made."""

from __future__ import annotations

import numpy as np

from engine.body import load_template
from engine.character.rig.measures import border_edges
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.mesh.surface import area_vectors


def test_it_is_closed_and_its_chart_is_of_the_same_triangles() -> None:
    mesh = template_mesh()
    border, crowded = border_edges(mesh.triangles)
    assert (len(border), crowded) == (0, 0)
    assert (mesh.corners[mesh.uv_triangles] == mesh.triangles).all()
    assert mesh.uv.min() >= 0 and mesh.uv.max() <= 1


def test_its_weights_are_whole_and_its_parts_are_those_of_its_joints() -> None:
    mesh = template_mesh()
    np.testing.assert_allclose(mesh.weights.sum(1), 1, atol=1e-6)
    np.testing.assert_allclose(mesh.parts.sum(1), 1, atol=1e-5)
    assert (np.diff(mesh.weights, axis=1) <= 1e-7).all()
    places = load_template().vertices[mesh.ids]
    for side, sign in (("Left", 1), ("Right", -1)):
        assert (sign * places[mesh.share(f"{side}Hand") > 0.9, 0]).min() > 0.2
    assert mesh.ear.sum() > 50 and (mesh.head[mesh.ear] > 0.9).all()


def test_the_template_s_vertices_are_found_by_their_numbers() -> None:
    mesh = template_mesh()
    assert (mesh.renamed(mesh.ids) == np.arange(len(mesh.ids))).all()
    volume = (
        area_vectors(places := load_template().vertices[mesh.ids], mesh.triangles) * places[mesh.triangles[:, 0]]
    ).sum() / 6
    assert 0.04 < volume < 0.1  # cubic metres: its outside is outside
