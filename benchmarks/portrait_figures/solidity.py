"""Whether hair, ears and skull turn with the face: a portrait of a scanned head against the scan that really turns."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from benchmarks.known_truth.head_scan import project_scan, read_head_scan, render_head
from benchmarks.portrait_figures.acting import Acting, read_driver, read_target
from benchmarks.portrait_figures.turn import HEAD_ZOOM_FACTOR, REST_FRAMES, TURNED_PICTURE_SIZE
from benchmarks.presentation.tables import table
from benchmarks.shared_media import media, tool, write_clip
from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget
from engine.face_animation.motion_transfer.contour import rim_distance
from engine.face_animation.motion_transfer.control_motion import ControlMotion
from engine.face_animation.warping.dense_field import interpolation
from engine.face_animation.warping.warp_mesh import WarpMesh
from engine.portrait.options import PortraitOptions

FILMED_YAW_DEGREES = (0.0, -6.0, -12.0, -18.0, -25.0, -18.0, -12.0, -6.0, 0.0, 6.0, 12.0, 18.0, 25.0)
"""Degrees, after the frames at rest: no step is longer than people's turns are."""
PICTURED_FACE_PIXELS = 256.0
"""Width of the face, pixels, at which distances are given."""
MIN_COUNTED_COSINE = 0.25
"""Cosine between a surface and the line of sight from which on a vertex is seen well, at rest and turned."""


def solidity() -> None:
    """Print how far skull and ears of a portrait, driven by a head that turns, are from where the scan's go."""
    scan = read_head_scan(media("scans3d/head_lee_perry_smith/head.obj").parent)
    angles = [0.0] * REST_FRAMES + [
        a for pair in zip(FILMED_YAW_DEGREES, FILMED_YAW_DEGREES, strict=True) for a in pair
    ]
    rendered = [render_head(scan, angle, TURNED_PICTURE_SIZE, None, HEAD_ZOOM_FACTOR) for angle in angles]
    true = [picture for picture, _ in rendered]
    disguised = tool("disguise").disguise(true, tool("face_measures").Landmarker()(true[0]))
    options = PortraitOptions(neutral_frame=0)
    with TemporaryDirectory() as folder:
        driver = write_clip(Path(folder) / "turn.mp4", disguised)
        target, layers, rig = read_target(Path(folder), true[0], options)
        track, neutral = read_driver(driver, target, 0)
        acting = Acting(track, neutral, target, layers, rig, options.acting())
    animation = FaceAnimation(RiggedTarget(target, layers, rig), RegisteredDriver(track, neutral), acting.options)
    motions = list(animation.motions())
    rest, seen = project_scan(scan, 0.0, TURNED_PICTURE_SIZE, HEAD_ZOOM_FACTOR)
    width = float(np.ptp(target.mesh[:, 0]))
    beside = rim_distance(target.mesh, rest) > 0
    above = rest[:, 1] < target.mesh[152, 1] - 0.1 * width
    rows = []
    for degrees in sorted(set(FILMED_YAW_DEGREES) - {0.0}):
        index = len(angles) - 1 - angles[::-1].index(degrees)
        there, still_seen = project_scan(scan, degrees, TURNED_PICTURE_SIZE, HEAD_ZOOM_FACTOR)
        chosen = np.flatnonzero(beside & above & (seen > MIN_COUNTED_COSINE) & (still_seen > MIN_COUNTED_COSINE))
        made = _carried(animation, motions[index], rig.mesh, rest[chosen])
        apart = np.linalg.norm(made - there[chosen], axis=1) * PICTURED_FACE_PIXELS / width
        still = np.linalg.norm(rest[chosen] - there[chosen], axis=1) * PICTURED_FACE_PIXELS / width
        rows.append(
            [f"{degrees:+.0f}", f"{still.mean():.2f}", f"{apart.mean():.2f}", f"{np.quantile(apart, 0.95):.2f}"]
        )
    head = ["degrees", "still px", "px", "95%"]
    print(
        table(
            "Solidity: skull and ears beside the face against the scan turned, pixels of a 256-pixel face", head, rows
        )
    )


def _carried(
    animation: FaceAnimation, motion: ControlMotion, mesh: WarpMesh, points: NDArray[np.floating]
) -> NDArray[np.float64]:
    """Where a motion takes points (P, 2) of the picture, pixels."""
    corners, weights = interpolation(mesh.vertices.astype(float), mesh.triangles, points)
    return np.asarray(points + (weights[..., None] * animation.moved(motion)[corners, :2]).sum(axis=1))
