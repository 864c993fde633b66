"""Eyes of the fitted face: eyeballs behind the irises that frames show, and lids that lie on them where frames show lids.

What lids leave to be seen of an eye, and where the iris is between them, is what makes a look; so neither is left to
the template. An eyeball is as large as its lids are wide, as in the template, and stands so deep that these need not
move ahead or back. It looks straight ahead, wherever the person looked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.landmarks.spatial import LID_POINT_COUNT
from engine.avatar.registration.eyes.eye_outline import EyeOutline, outline_of_landmarks, outline_of_rim, within
from engine.avatar.registration.eyes.eyeballs import LID_GAP_METRES, before_eyeball, sphere
from engine.avatar.registration.template_skin.lid_rims import lid_rim
from engine.avatar.registration.template_skin.skin import EYE_PARTS, Skin, grown
from engine.body.template import Template
from engine.geometry.deformation.smooth_field import smooth_field
from engine.geometry.registration.rigid import Similarity, fit_similarity

BALL_RADII = (0.012, 0.0175)
"""Metres: least and greatest radius of an eyeball. The least is a human one's; the template's lids are wide, and so is its eyeball."""
IRIS_RADIUS_METRES, IRIS_RADIUS_RANGE_METRES = 0.00585, (0.0052, 0.0072)
"""Metres: the radius of a human iris, and between which one is believed that is measured."""
MAX_EYEBALL_OFFSET_METRES = np.array([0.003, 0.002])
"""Metres, outwards and up, by which an eyeball stands off its usual place between the lids at most: what is more is a gaze."""
HORIZON_RADII = 0.94
"""Radii off the axis of gaze beyond which an eyeball's surface falls too steeply for lids to lie on it."""
FOLLOWING_LID_RINGS = 7
"""Rings of vertices about a rim that go with it: over fewer lids are crumpled that stand elsewhere than the fit has left them."""
SOCKET_REACH_RADII = 1.3
"""Radii of the template's eyeball about its middle within which skin that is not seen is its socket."""
SOCKET_RADII = 0.93
"""Radii of the eyeball at which its socket is put: within it, so that it shows neither between this and the lids nor through these."""
INNER_CORNER_LANDMARKS = {"left_eye": 42, "right_eye": 39}
"""Face landmarks."""
OUTWARD_SIGNS = {"left_eye": 1.0, "right_eye": -1.0}
"""Along the template's x."""


@dataclass(frozen=True)
class FittedEyes:
    """vertices : (V, 3) of the whole template, with its eyes and the lids on them.
    iris : metres, the radius of both irises.
    measured : whether frames have shown lids and irises.
    """

    vertices: NDArray[np.float64]
    iris: float
    measured: bool


def with_sockets(template: Template, skin: Skin, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """The template's `vertices` (V, 3) with the sockets of the eyes within the eyeballs."""
    out = vertices.copy()
    inner = skin.vertices[skin.regions["inner"]]
    for part in EYE_PARTS:
        at = template.vertices_of(part)
        ball = template.vertices[at].astype(np.float64)
        middle, radius = sphere(ball)
        away = template.vertices[inner] - middle
        far = np.linalg.norm(away, axis=1)
        near = far < SOCKET_REACH_RADII * radius
        within_ball = middle + SOCKET_RADII * radius * away[near] / far[near, None]
        out[inner[near]] = fit_similarity(ball, vertices[at])(within_ball)
    return out


@dataclass(frozen=True)
class _Eye:
    """One eye of the template and of the person.

    part : its eyeball.
    rim : (R,) the template's vertices.
    own : (R, 3) where these are in the template, in radii from the middle of the eyeball.
    inner : (3,) where the inner corner is there.
    axes : (3, 3) outwards, up and ahead, in the person's world.
    goal : the outline that the person's lids have in that world, metres.
    iris : (2,) where the iris is in it; None where it was not seen.
    lids : (16, 3) where the lids are there, ahead, too; None where they were not seen.
    """

    part: str
    rim: NDArray[np.intp]
    own: NDArray[np.float64]
    inner: NDArray[np.float64]
    axes: NDArray[np.float64]
    goal: EyeOutline
    iris: NDArray[np.float64] | None
    lids: NDArray[np.float64] | None

    @property
    def outline(self) -> EyeOutline:
        """The template's."""
        return outline_of_rim(self.own[:, :2], self.inner[:2])

    def usual_middle(self) -> NDArray[np.float64]:
        """(2,) where the template has an eyeball between such lids."""
        at = self.outline
        share = at.share(np.zeros(1))[0]
        level = self.goal.level(np.array([share]))[0]
        low, high = self.goal.lids(np.array([share]))
        own_low, own_high = at.lids(np.array([share]))
        own_level = at.level(np.array([share]))[0]
        scale = self.goal.width / at.width
        lids = (low[0] + high[0]) / 2 - level - scale * ((own_low[0] + own_high[0]) / 2 - own_level)
        return np.array([self.goal.outer[0] - share * self.goal.width, level - scale * own_level + lids])


def with_eyes(
    template: Template,
    skin: Skin,
    before: NDArray[np.float64],
    vertices: NDArray[np.float64],
    head: Similarity,
    seen: NDArray[np.floating],
) -> FittedEyes:
    """The template's `vertices` (V, 3) with its eyes and lids as frames have `seen` them, (2, 21, 3) landmarks of the left and the
    right one, NaN where not known: there lids are where the skin was fitted. `before` (V, 3): the template before the fit, of which
    the `head` has become what it is."""
    eyes = [_eye(template, skin, part, before, vertices, head, one) for part, one in zip(EYE_PARTS, seen, strict=True)]
    measured = all(eye.iris is not None for eye in eyes)
    scale = float(np.mean([eye.goal.width / eye.outline.width for eye in eyes]))
    radius = float(np.clip(scale, *BALL_RADII))
    out = vertices.copy()
    rims = {}
    for eye, off in zip(eyes, _off_usual_place(eyes), strict=True):
        across = within(eye.own[:, :2], eye.outline, eye.goal)
        middle_across = eye.usual_middle() + off
        ahead = _ahead(across - middle_across, radius)
        depth = float(np.mean(vertices[eye.rim] @ eye.axes[2] - ahead))
        if eye.lids is not None:  # landmarks are ahead of the lids as a rule, where the fitted skin is behind them
            depth = (depth + float(np.mean(eye.lids[:, 2] - _ahead(eye.lids[:, :2] - middle_across, radius)))) / 2
        rims[eye.part] = np.column_stack([across, depth + ahead]) @ eye.axes
        ball = template.vertices[template.vertices_of(eye.part)].astype(np.float64)
        own_middle, own_radius = sphere(ball)
        turned = (ball - own_middle) / own_radius * [OUTWARD_SIGNS[eye.part], 1, 1] @ eye.axes
        out[template.vertices_of(eye.part)] = np.array([*middle_across, depth]) @ eye.axes + radius * turned
    out[skin.vertices] = _lids(template, skin, before, out, head, {eye.part: eye.rim for eye in eyes}, rims)
    return FittedEyes(out, _iris_radius(seen) if measured else IRIS_RADIUS_METRES, measured)


def _eye(
    template: Template,
    skin: Skin,
    part: str,
    before: NDArray[np.float64],
    vertices: NDArray[np.float64],
    head: Similarity,
    seen: NDArray[np.floating],
) -> _Eye:
    at = template.vertices_of(part)
    ball = template.vertices[at].astype(np.float64)
    middle, radius = sphere(ball)
    turn = head.rotation @ fit_similarity(ball, before[at]).rotation
    mirrored = np.array([OUTWARD_SIGNS[part], 1, 1])
    rim = lid_rim(template, part)
    corner = skin.vertices[skin.face_points[INNER_CORNER_LANDMARKS[part]]]
    own, inner = ((template.vertices[k] - middle) / radius * mirrored for k in (rim, corner))
    axes = turn.T * mirrored[:, None]
    if np.isfinite(seen).all():
        lids = np.asarray(seen[:LID_POINT_COUNT] @ axes.T)
        iris = np.asarray(axes[:2] @ seen[LID_POINT_COUNT])
        return _Eye(part, rim, own, inner, axes, outline_of_landmarks(lids[:, :2]), iris, lids)
    goal = outline_of_rim(vertices[rim] @ axes[:2].T, axes[:2] @ vertices[corner])
    return _Eye(part, rim, own, inner, axes, goal, None, None)


def _off_usual_place(eyes: list[_Eye]) -> list[NDArray[np.float64]]:
    """By how much each eyeball stands off its usual place between the lids, (2,) metres: as its iris does, but for what both do to
    the same side, which is where the person looked."""
    off = []
    for eye in eyes:
        if eye.iris is None:
            return [np.zeros(2)] * len(eyes)
        off.append(np.asarray(eye.iris - eye.usual_middle()))
    return [np.clip(np.mean(off, 0), -MAX_EYEBALL_OFFSET_METRES, MAX_EYEBALL_OFFSET_METRES)] * len(eyes)


def _ahead(off: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """(N,) how far ahead of an eyeball's middle lids lie on it that are so far `off` (N, 2) its axis."""
    across = np.minimum(np.linalg.norm(off, axis=1), HORIZON_RADII * radius)
    return np.asarray(np.sqrt((radius + LID_GAP_METRES) ** 2 - across**2))


def _iris_radius(seen: NDArray[np.floating]) -> float:
    """Metres, of irises in landmarks (2, 21, 3): half of how far their sides are apart, which lids do not hide."""
    sides = seen[:, LID_POINT_COUNT + 1] - seen[:, LID_POINT_COUNT + 3]
    return float(np.clip(np.linalg.norm(sides, axis=1).mean() / 2, *IRIS_RADIUS_RANGE_METRES))


def _lids(
    template: Template,
    skin: Skin,
    before: NDArray[np.float64],
    vertices: NDArray[np.float64],
    head: Similarity,
    rims: dict[str, NDArray[np.intp]],
    places: dict[str, NDArray[np.float64]],
) -> NDArray[np.float64]:
    """The skin (S, 3) of the whole template `vertices` (V, 3) with the `rims` of its lids at their `places`, and nothing of the lids
    within an eyeball.

    Lids between their rims and the skin about them keep the folds that they had before, but for a smooth displacement.
    The fit crumples them where an eye is opened wider, and between them points are of the eye.
    """
    fitted = vertices[skin.vertices].copy()
    own = head(before[skin.vertices])
    rim = np.concatenate([skin.index_of(loop) for loop in rims.values()])
    near = grown(np.isin(np.arange(len(fitted)), rim), skin.triangles, FOLLOWING_LID_RINGS)
    lids = (skin.regions["lids"] | near) & ~skin.regions["inner"]
    free = lids.copy()
    free[rim] = False
    fitted[rim] = np.concatenate([places[part] for part in rims])
    fitted[lids] = (own + smooth_field(skin.triangles, free, fitted - own))[lids]
    outside = skin.regions["face"] & ~skin.regions["inner"]
    for part in rims:
        fitted[outside] = before_eyeball(vertices[template.vertices_of(part)], fitted[outside])
    return fitted
