"""The avatar's texture: eyes have more room, and nothing lies on anything else."""

import numpy as np

from engine.avatar.eye_charts import EYE_SCALE, avatar_uv
from engine.avatar.mesh import AVATAR_PARTS
from engine.body.template import load_template
from engine.geometry.mesh.surface import triangulate
from engine.geometry.texture_charts.texture_atlas import TextureAtlas, atlas_from_uv
from engine.render.textures.texture_bake import chart_gap, charts_of, texel_raster


def atlas(uv: np.ndarray) -> TextureAtlas:
    template = load_template()
    return atlas_from_uv(uv, triangulate(template.uv_quads[template.faces(*AVATAR_PARTS)]))


def doubled_area(uv: np.ndarray, corners: np.ndarray) -> np.ndarray:
    a, b, c = (uv[corners[:, k]].astype(np.float64) for k in range(3))
    return np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def test_the_fronts_of_the_eyes_are_enlarged_and_nothing_else_is_moved() -> None:
    template = load_template()
    moved = (avatar_uv(template) != template.uv).any(1)
    for part in AVATAR_PARTS:
        faces = template.faces(part)
        corners, points = triangulate(template.uv_quads[faces]), triangulate(template.quads[faces])
        of_part = moved[corners].all(1)
        if not part.endswith("eye"):
            assert not moved[corners].any()
            continue
        middles = template.vertices[points].mean(1)
        assert (of_part == (middles[:, 2] > template.vertices[points].mean((0, 1))[2])).mean() > 0.95
        ratio = doubled_area(avatar_uv(template), corners) / doubled_area(template.uv, corners)
        np.testing.assert_allclose(ratio[of_part], EYE_SCALE**2, rtol=0.02)


def test_the_eyes_keep_apart_from_everything_else() -> None:
    template, uv = load_template(), avatar_uv(load_template())
    charts = charts_of(atlas(uv), texel_raster(atlas(uv), 1024))
    corners = triangulate(template.uv_quads[template.faces(*AVATAR_PARTS)])
    enlarged = np.unique(atlas(uv).charts[(uv != template.uv).any(1)[corners].all(1)])
    assert len(enlarged) == 2
    others = np.where(np.isin(charts, enlarged), charts, np.where(charts >= 0, charts.max() + 1, -1))
    assert chart_gap(others.astype(np.int32)) > 16
    shown = np.isin(charts, enlarged).sum()
    expected = doubled_area(uv, corners)[np.isin(atlas(uv).charts, enlarged)].sum() / 2 * 1024**2
    np.testing.assert_allclose(shown, expected, rtol=0.02)
