"""The actor's body: eyes that shut, lids that stay on the eyeball, teeth that stay behind the lips."""

import numpy as np
import pytest

from engine.geometry.mesh.surface import triangulate
from engine.performances.modelling.eyes import (
    CORNEA_RADIUS,
    EYEBALL_RADIUS_METRES,
    IRIS_RADIUS,
    build_eyeball,
    colour_of_eye,
    profile,
)
from engine.performances.modelling.figure import Figure, Pose, build_figure, pose_figure, rigid_motion
from engine.render.rasterisation.rasteriser import rasterise

SMILE = {f"{unit}{side}": 0.8 for unit in ("mouthSmile", "cheekSquint") for side in ("Left", "Right")}
WIDE = {"eyeWideLeft": 0.85, "eyeWideRight": 0.85, "browInnerUp": 1.0}


@pytest.fixture(scope="module")
def figure() -> Figure:
    return build_figure()


def visible_eye(figure: Figure, pose: Pose) -> int:
    """Pixels of both eyeballs that are seen from the front, at ten pixels to the millimetre."""
    posed, ball = pose_figure(figure, pose), build_eyeball()
    balls = [
        (ball.vertices + eye.centre) @ m[:3, :3].T + m[:3, 3] for eye, m in zip(figure.eyes, posed.eyes, strict=True)
    ]
    skin = triangulate(figure.quads)
    vertices = np.concatenate([posed.skin, *balls])
    count = len(ball.vertices)
    faces = [skin, ball.triangles + len(posed.skin), ball.triangles + len(posed.skin) + count]
    middle = np.mean([eye.centre for eye in figure.eyes], axis=0)
    x, y = (vertices[:, 0] - middle[0]) * 10000 + 500, -(vertices[:, 1] - middle[1]) * 10000 + 200
    raster = rasterise(np.stack([x, y, -vertices[:, 2]], 1), np.concatenate(faces), (400, 1000))
    return int((raster.triangle >= len(skin)).sum())


@pytest.mark.parametrize("expression", [{}, SMILE, WIDE], ids=["neutral", "smile", "wide"])
def test_a_full_blink_shuts_the_eye_in_every_expression(figure: Figure, expression: dict[str, float]) -> None:
    opened = visible_eye(figure, Pose(units=expression))
    shut = visible_eye(figure, Pose(units={**expression, "eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}))
    assert opened > 20000
    assert shut < 0.01 * opened


def test_half_a_blink_halves_the_opening(figure: Figure) -> None:
    opened = visible_eye(figure, Pose())
    half = visible_eye(figure, Pose(units={"eyeBlinkLeft": 0.5, "eyeBlinkRight": 0.5}))
    assert 0.25 < half / opened < 0.65


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("gaze", [(0.0, 0.0), (5.0, -12.0)])
def test_lids_never_sink_into_the_eyeball(figure: Figure, share: float, gaze: tuple[float, float]) -> None:
    posed = pose_figure(figure, Pose(units={"eyeBlinkLeft": share}, gaze=gaze))
    motion = posed.eyes[0]
    local = (posed.skin - (motion[:3, :3] @ figure.eyes[0].centre + motion[:3, 3])) @ motion[:3, :3]
    distance = np.linalg.norm(local, axis=1)
    cosine = local[:, 2] / np.maximum(distance, 1e-9)
    ahead = (cosine > 0.3) & (distance < 0.025)
    assert (distance[ahead] >= profile(cosine[ahead]) + 1e-4).all()


def test_turning_the_head_moves_the_skull_rigidly(figure: Figure) -> None:
    still, turned = pose_figure(figure, Pose()), pose_figure(figure, Pose(head=(4.0, -8.0, 3.0)))
    crown = still.skin[:, 1] > still.skin[:, 1].max() - 0.06
    expected = still.skin[crown] @ turned.head[:3, :3].T + turned.head[:3, 3]
    np.testing.assert_allclose(turned.skin[crown], expected, atol=3e-4)


def test_breath_lifts_the_shoulders_and_not_the_crown(figure: Figure) -> None:
    out, full = pose_figure(figure, Pose()), pose_figure(figure, Pose(breath=1.0))
    shoulder = np.abs(out.skin[:, 0]) > 0.15
    assert 0.0005 < (full.skin - out.skin)[shoulder, 1].mean() < 0.006
    assert np.abs((full.skin - out.skin)[out.skin[:, 1] > 0.85]).max() < 0.006


def test_rigid_motions_are_found_again() -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(20, 3))
    angle = 0.4
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    found = rigid_motion(points, points @ turn.T + [1, 2, 3])
    np.testing.assert_allclose(found[:3, :3], turn, atol=1e-9)
    np.testing.assert_allclose(found[:3, 3], [1, 2, 3], atol=1e-9)


def test_the_cornea_bulges_by_as_much_as_its_curvature_says() -> None:
    assert profile(np.array([0.5]))[0] == EYEBALL_RADIUS_METRES
    rim = np.sqrt(EYEBALL_RADIUS_METRES**2 - IRIS_RADIUS**2)
    height = rim + CORNEA_RADIUS - np.sqrt(CORNEA_RADIUS**2 - IRIS_RADIUS**2)
    assert profile(np.array([1.0]))[0] == pytest.approx(height)
    cosines = np.linspace(0.3, 1, 500)
    assert np.abs(np.diff(profile(cosines))).max() < 1e-4  # no step at the rim


def test_the_pupil_is_black_and_the_white_is_white() -> None:
    front = np.array(
        [[0, 0, float(profile(np.array([1.0]))[0])], [0.010, 0, np.sqrt(EYEBALL_RADIUS_METRES**2 - 0.010**2)]]
    )
    albedo, cornea = colour_of_eye(front, np.tile([0.0, 0.0, 1.0], (2, 1)))
    assert albedo[0].max() < 0.02 and cornea[0] == 1
    assert albedo[1].min() > 0.35 and cornea[1] == 0
