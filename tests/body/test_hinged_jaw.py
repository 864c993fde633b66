"""A jaw that opens turns about its hinges."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.body.hinged_jaw import CLOSED_LIPS_SHARE, CORNER_SHARE
from engine.body.lip_sides import lip_rims
from engine.body.template import Template, load_rig, mouth_faces, vertex_mask
from engine.geometry.mesh.surface import triangulate
from engine.geometry.registration.rigid import fit_rigid


@pytest.fixture(scope="module")
def opened(template: Template) -> NDArray[np.float64]:
    return template.vertices + template.face_units.displacement({"jawOpen": 1.0}).astype(np.float64)


@pytest.fixture(scope="module")
def shares(template: Template, opened: NDArray[np.float64]) -> NDArray[np.float64]:
    """(V,) of the way that each vertex would go with the lower teeth, the share that it goes."""
    teeth = template.vertices_of("lower_teeth")
    way = fit_rigid(template.vertices[teeth].astype(np.float64), opened[teeth])(template.vertices) - template.vertices
    return np.asarray(((opened - template.vertices) * way).sum(1) / (way**2).sum(1))


@pytest.fixture(scope="module")
def rims(template: Template) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    skin = template.vertices_of("body")
    triangles = triangulate(np.searchsorted(skin, template.quads[template.faces("body")]))
    upper, lower = lip_rims(template.vertices[skin], triangles, np.tile(mouth_faces(template), 2))
    return skin[upper], skin[lower]


def test_the_chin_keeps_its_shape(template: Template, opened: NDArray[np.float64]) -> None:
    jaw = load_rig("default").weights_below("jaw")
    chin = np.flatnonzero((jaw > 0.7) & (template.vertices[:, 1] < 0.64) & (template.vertices[:, 2] > 0.1))
    chin = np.intersect1d(chin, template.vertices_of("body"))
    before = template.vertices[chin].astype(np.float64)
    assert np.ptp(before[:, 0]) > 0.05  # from one side to the other
    turned = fit_rigid(before, opened[chin])
    assert np.abs(turned(before) - opened[chin]).max() < 0.0002
    angle = np.degrees(np.arccos((np.trace(turned.linear) - 1) / 2))
    assert 18 < angle < 24
    hinge = np.array([0, 0.684, 0.066])  # before the ears
    assert np.linalg.norm(turned(hinge[None]) - hinge) < 0.002


def test_a_mouth_opens_round_between_its_corners(
    template: Template, shares: NDArray[np.float64], rims: tuple[NDArray[np.intp], NDArray[np.intp]]
) -> None:
    """An ellipse is as high as half of its height 0.134 of its half width from the corners, a V 0.5 of it."""
    for rim, middle in zip(rims, (0, 1), strict=True):
        side = rim[template.vertices[rim, 0] >= -1e-6]
        side = side[np.argsort(template.vertices[side, 0])]
        across = template.vertices[side, 0] / template.vertices[side, 0].max()
        assert shares[side[0]] == pytest.approx(middle, abs=0.02)
        half = np.interp(np.sqrt(0.75), across, shares[side])
        assert half == pytest.approx((middle + CORNER_SHARE) / 2, abs=0.07)


def test_the_skull_stays(template: Template, opened: NDArray[np.float64]) -> None:
    moved = np.linalg.norm(opened - template.vertices, axis=1)
    skin = template.vertices_of("body")
    at = template.vertices[skin]
    nose = (np.abs(at[:, 0]) < 0.015) & (at[:, 1] > 0.685) & (at[:, 1] < 0.73) & (at[:, 2] > 0.14)
    assert nose.sum() > 50 and moved[skin[nose]].max() < 0.001
    assert moved[skin[vertex_mask(template, "ears")[skin] > 0.5]].max() < 0.001
    assert not moved[template.vertices_of("upper_teeth")].any()


def test_lips_close_over_an_open_jaw(template: Template) -> None:
    """They go all alike, so that what touched touches, and the chin stays down."""
    units = template.face_units
    shut = units.displacement({"jawOpen": 1.0, "mouthClose": 1.0}).astype(np.float64)
    skin = template.vertices_of("body")
    lips = skin[vertex_mask(template, "lips")[skin] > 0.5]
    places = template.vertices.astype(np.float64)
    teeth = template.vertices_of("lower_teeth")
    way = fit_rigid(places[teeth], places[teeth] + units.displacement({"jawOpen": 1.0})[teeth])(places) - places
    assert np.abs(shut[lips] - CLOSED_LIPS_SHARE * way[lips]).max() < 0.0002
    chin = skin[(np.abs(places[skin, 0]) < 0.01) & (np.abs(places[skin, 1] - 0.615) < 0.01) & (places[skin, 2] > 0.13)]
    assert len(chin) > 3 and np.abs(shut[chin] - way[chin]).max() < 0.003
