"""Smiles that move cheeks."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.body.mouth_skin import MouthSkin
from engine.body.smile_cheeks import MOUTH_FOLD_METRES, TISSUE_THICKNESS_METRES, with_cheeks
from engine.body.template import Template, load_drawn_template, mouth_faces, vertex_mask
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.surface import triangulate

STEP = 0.004


@pytest.fixture(scope="module")
def flat() -> MouthSkin:
    """A sheet, 16 cm wide and high, across z, with lips, 2.4 by 1.6 cm, around a slit whose middle rows are the mouth's inside."""
    count = 41
    x, y = np.meshgrid(np.arange(count) - 20, np.arange(count) - 20)
    at = np.arange(count * count).reshape(count, count)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], -1).reshape(-1, 4)
    middles = np.stack([x, y], -1).reshape(-1, 2)[quads].mean(1)
    slit = (np.abs(middles[:, 0]) < 2) & (np.abs(middles[:, 1]) < 1)
    lips = (np.abs(x) <= 3) & (np.abs(y) <= 2)
    places = np.stack([x, y, 0 * x], -1).reshape(-1, 3) * STEP
    return MouthSkin(places, triangulate(quads), np.tile(slit, 2), np.zeros(count**2), lips.ravel())


def drawn_aside(skin: MouthSkin) -> NDArray[np.float64]:
    """Lips that go 8 mm to the left, and 10 cm about them in which the skin goes along by less and less."""
    away = np.linalg.norm(skin.vertices, axis=1)
    return np.clip(1.2 - away / 0.07, 0, 1)[:, None] * np.array([0.008, 0.0, 0.0])


def test_lips_go_as_drawn_and_what_was_still_stays(flat: MouthSkin) -> None:
    drawn = drawn_aside(flat)
    made = with_cheeks(flat, drawn)
    assert np.abs(made - drawn)[flat.lips].max() < 1e-9
    assert not made[np.linalg.norm(drawn, axis=1) < 0.001].any()


def test_a_ledge_goes_and_what_is_broad_remains(flat: MouthSkin) -> None:
    broad = drawn_aside(flat)
    column = np.isclose(flat.vertices[:, 0], 8 * STEP) & (np.abs(flat.vertices[:, 1]) < 0.03)
    ledge = broad + column[:, None] * np.array([0.0, 0.0, 0.003])
    smooth, made = (with_cheeks(flat, one) for one in (broad, ledge))
    assert np.abs(made - smooth)[column].max() < 0.001
    beside = column & (np.abs(flat.vertices[:, 1]) < 0.01)
    assert np.abs(smooth[beside, 0] - broad[beside, 0]).max() < 0.0006


def test_what_the_skin_loses_in_width_comes_out_before_the_lips_and_beside_the_fold(flat: MouthSkin) -> None:
    """The sheet is narrowed at its left side and widened at its right, and its tissue is as much as it was where it was narrowed."""
    drawn = drawn_aside(flat)
    out = with_cheeks(flat, drawn)[:, 2]
    from_lips = np.linalg.norm(np.clip(np.abs(flat.vertices[:, :2]) - [3 * STEP, 2 * STEP], 0, None), axis=1)
    assert out.min() == 0 and not out[from_lips < MOUTH_FOLD_METRES - 1e-9].any()
    assert flat.vertices[np.argmax(out), 0] > 0
    assert out[flat.vertices[:, 0] > 0].sum() > 3 * out[flat.vertices[:, 0] < 0].sum()
    narrowed = -np.gradient(with_cheeks(flat, drawn)[:, 0].reshape(41, 41), STEP, axis=1).ravel()
    counted = np.clip(np.where(from_lips > 0, narrowed, 0), 0, None).sum() * TISSUE_THICKNESS_METRES
    assert out.sum() == pytest.approx(counted, rel=0.15)


def test_the_template_smiles_without_a_line(template: Template) -> None:
    """A displacement that bends sharply is a line in the skin: by how much a vertex's differs from its neighbours' mean."""
    skin = template.vertices_of("body")
    places = template.vertices[skin].astype(np.float64)
    quads = np.searchsorted(skin, template.quads[template.faces("body")])
    triangles = triangulate(quads)
    inside = np.zeros(len(skin), np.bool_)
    inside[quads[mouth_faces(template)]] = True
    corner = np.argmax(np.where(vertex_mask(template, "lips")[skin] > 0.5, places[:, 0], 0))
    away = np.linalg.norm(places - places[corner], axis=1)
    ring = (away > 0.012) & (away < 0.03) & ~inside
    beside = neighbours(triangles, len(skin))
    bends = []
    for one in (load_drawn_template(), template):
        moved = one.face_units.displacement({"mouthSmileLeft": 1.0})[skin].astype(np.float64)
        bends.append(np.linalg.norm(moved - beside @ moved / beside.sum(1)[:, None], axis=1)[ring])
        assert moved[corner] == pytest.approx([0.0098, 0.0137, -0.0073], abs=0.003)
    assert np.quantile(bends[1], 0.95) < 0.6 * np.quantile(bends[0], 0.95)
