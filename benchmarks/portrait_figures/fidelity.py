"""How near an animation comes to the truth: a clip's first frame, driven by the clip disguised as another's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay

from benchmarks.portrait_figures.acting import Acting, read_driver, read_target
from benchmarks.presentation.contact_sheet import Row, contact_sheet, evenly, write_sheet
from benchmarks.presentation.tables import mean_row, table
from benchmarks.shared_media import driving_clips, media, tool, write_clip
from engine.face_animation.animation import Parts
from engine.face_animation.face_rig import rig_target
from engine.face_animation.motion_transfer.alignment import align
from engine.face_animation.motion_transfer.control_points import carry_fiducials
from engine.imaging.warping.mesh_warp import inverse_map
from engine.media.image import read_image
from engine.perception.face.faces import find_faces
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, LIPS_OUTER, RIGHT_EYE, eye_distance
from engine.perception.masks.segmentation import person_confidence
from engine.portrait.options import PortraitOptions

MAX_CLIP_FRAMES, COMPARED_FRAME_STEP = 240, 8
"""As the yardsticks were taken: every 8th of the first 240 frames."""
PICTURE_REGIONS = ("face", "mouth", "eyes", "hair", "background")
"""`hair` is the person outside the face: hair, ears, neck and shoulders."""
WARP_ALONE = Parts(layers=False, hidden=False, details=False, own_folds=False, eyes=False)
IN_PLANE, IN_SPACE = False, True
"""Whether heads turn in 3D."""
SMOOTHING_MODES = {"warp, no smoothing": "none", "warp, constant smoothing": "constant"}
FULL_RATIO_TITLE = "+ full ratio image"
ALL_TITLE = "+ second look (all)"
ABLATION_ROWS: tuple[tuple[str, Parts, bool], ...] = (
    ("warp, no smoothing", WARP_ALONE, IN_PLANE),
    ("warp, constant smoothing", WARP_ALONE, IN_PLANE),
    ("warp, confidence-aware", WARP_ALONE, IN_PLANE),
    ("+ hidden regions", replace(WARP_ALONE, hidden=True), IN_PLANE),
    (FULL_RATIO_TITLE, replace(WARP_ALONE, hidden=True, details=True, own_folds=True), IN_PLANE),
    ("+ refined ratio image", replace(WARP_ALONE, hidden=True, details=True, own_folds=True), IN_PLANE),
    ("+ layers", replace(WARP_ALONE, hidden=True, details=True, own_folds=True, layers=True), IN_PLANE),
    ("+ eyes", Parts(), IN_PLANE),
    ("+ 3D head", Parts(), IN_SPACE),
    (ALL_TITLE, Parts(), IN_SPACE),
)


def fidelity(names: Sequence[str], pictures: Path | None) -> None:
    """Print the main table: still frame, bare warp, ours on the disguised clip, ours on the clip itself."""
    rows, figures, compared = [], [], []
    for path in driving_clips(names):
        with TemporaryDirectory() as folder:
            true, acting, own = _prepared(path, Path(folder), with_self=True)
            kept = true[::COMPARED_FRAME_STEP]
            bare = _bare_warp(acting)
            made = list(acting.frames(step=COMPARED_FRAME_STEP))
            still, warp, ours = (_measures(kept, f) for f in ([kept[0]] * len(kept), bare, made))
            itself = _measures(kept, list(own.frames(step=COMPARED_FRAME_STEP)))
            regions = _regional(kept, made)
        values = [*still, *warp, *ours, *(regions[r] for r in ("face", "hair", "background")), *itself]
        figures.append(values)
        compared.append((warp, ours))
        rows.append([path.stem, *_shown(values, COLUMN_DIGITS)])
        _save(pictures, f"fidelity-{path.stem}", kept, bare, made)
    rows.append(mean_row("mean", figures, COLUMN_DIGITS))
    head = ["clip", "still L1", "px", "SSIM", "warp L1", "px", "SSIM", "ours L1", "px", "SSIM", "face", "hair", "backgr.", "self L1", "px", "SSIM"]  # fmt: skip
    print(table("Fidelity: a clip's first frame driven by the disguised clip, against the clip", head, rows))
    print("\nL1 in [0, 1]; px: mean distance of 68 points at 256 px; face, hair, backgr.: ours' L1 split.")
    ahead = [ours[0] < warp[0] and (ours[1] or 9) < (warp[1] or 0) for warp, ours in compared]
    print(f"Ahead of the bare warp on both: {sum(ahead)} of {len(ahead)} clips.")


SHEET_COLUMNS = 8
"""Frames side by side on a contact sheet, at most."""
SHEET_WIDTH_PIXELS = 2400
"""Pixels of a contact sheet's width."""
COLUMN_DIGITS = (4, 2, 4, 4, 2, 4, 4, 3, 4, 4, 4, 4, 4, 3, 4)


def ablations(names: Sequence[str], pictures: Path | None) -> None:
    """Print what each part of the method gains, region by region."""
    figures: dict[str, list[list[float | None]]] = {label: [] for label, _, _ in ABLATION_ROWS}
    for path in driving_clips(names):
        with TemporaryDirectory() as folder:
            true, acting, _ = _prepared(path, Path(folder), with_self=False)
            kept = true[::COMPARED_FRAME_STEP]
            for label, parts, head_3d in ABLATION_ROWS:
                rig = rig_target(acting.target, acting.layers, smoothing=SMOOTHING_MODES.get(label, "confidence"))
                options = replace(acting.options, head_3d=head_3d)
                varied = replace(acting, rig=rig, options=options, looked=label == ALL_TITLE)
                made = list(varied.frames(parts, refined=label != FULL_RATIO_TITLE, step=COMPARED_FRAME_STEP))
                regions = _regional(kept, made)
                figures[label].append([*_measures(kept, made), *(regions[r] for r in PICTURE_REGIONS)])
                _save(pictures, f"ablation-{path.stem}-{label.strip('+ ').replace(' ', '_')}", kept, made)
    rows = [mean_row(label, values, (4, 3, 4, *(4,) * len(PICTURE_REGIONS))) for label, values in figures.items()]
    print(
        table("Ablations: mean over the clips, disguised driver", ["parts", "L1", "px", "SSIM", *PICTURE_REGIONS], rows)
    )
    print("\nThe columns from `face` on are the L1 of that region alone, where each part should help.")


def pair(pictures: Path | None) -> None:
    """Print how near the neutral portrait, driven toward the smile, comes to the real smile."""
    neutral, smile = (read_image(media(f"portraits/pair1_{name}.png")).rgb for name in ("neutral", "smile"))
    true = [neutral] * 12 + [smile] * 24
    landmarks = tool("face_measures").Landmarker()(neutral)
    rows = []
    for label, driver in (("disguised", tool("disguise").disguise(true, landmarks)), ("itself", true)):
        with TemporaryDirectory() as folder:
            options = PortraitOptions(neutral_frame=0)
            target, layers, rig = read_target(Path(folder), neutral, options)
            track, chosen = read_driver(write_clip(Path(folder) / "driver.mp4", driver), target, 0)
            made = list(Acting(track, chosen, target, layers, rig, options.acting()).frames())[-1]
        kept = [neutral, smile]
        still, ours = (_measures(kept, [neutral, frame], last=True) for frame in (neutral, made))
        rows.append([label, *_shown([*still, *ours], (4, 2, 4, 4, 2, 4))])
        _save(pictures, f"pair-{label}", kept, [neutral, made])
    head = ["driven by the pair", "still L1", "px", "SSIM", "ours L1", "px", "SSIM"]
    print(table("The pair: neutral driven toward the smile, against the real smile", head, rows))


def _prepared(path: Path, folder: Path, with_self: bool) -> tuple[list[NDArray[np.uint8]], Acting, Acting]:
    """The true frames; the first one with the disguised clip; and with the clip itself where asked for."""
    measures = tool("face_measures")
    true = measures.frames(path, MAX_CLIP_FRAMES)
    height, width = (side - side % 2 for side in true[0].shape[:2])
    true = [np.ascontiguousarray(frame[:height, :width]) for frame in true]
    disguised = tool("disguise").disguise(true, measures.Landmarker()(true[0]))
    options = PortraitOptions(neutral_frame=0, size=(width, height) if max(width, height) > 64 else None)
    target, layers, rig = read_target(folder, true[0], options)
    track, neutral = read_driver(write_clip(folder / "disguised.mp4", disguised), target, 0)
    acting = Acting(track, neutral, target, layers, rig, options.acting())
    if not with_self:
        return true, acting, acting
    track, neutral = read_driver(write_clip(folder / "itself.mp4", true), target, 0)
    return true, acting, Acting(track, neutral, target, layers, rig, options.acting())


def _bare_warp(acting: Acting) -> list[NDArray[np.uint8]]:
    """The yardstick: the mesh's points by equation 1, a fixed border, piecewise affine, nothing else."""
    rgb, rest = acting.target.rgb, acting.target.mesh[:468, :2]
    height, width = rgb.shape[:2]
    xs, ys = np.linspace(0, width - 1, 9), np.linspace(0, height - 1, 9)
    border = np.array([(x, y) for x in xs for y in ys if x in (xs[0], xs[-1]) or y in (ys[0], ys[-1])])
    meshes = acting.track.meshes[::COMPARED_FRAME_STEP]
    neutral = acting.track.meshes[acting.neutral]
    moved = carry_fiducials(align(neutral, acting.target.mesh), meshes, neutral, acting.target.mesh)[:, :468]
    points = np.concatenate([rest, border]).astype(np.float32)
    triangles = Delaunay(points).simplices.astype(np.int32)
    frames = []
    for face in moved:
        placed = np.concatenate([face, border]).astype(np.float32)
        origin = inverse_map(placed, points, triangles, (height, width))
        frames.append(np.asarray(cv2.remap(rgb, origin[..., 0], origin[..., 1], cv2.INTER_LINEAR), np.uint8))
    return frames


def _measures(
    true: list[NDArray[np.uint8]], made: list[NDArray[np.uint8]], last: bool = False
) -> tuple[float, float | None, float]:
    """L1, mean distance of the 68 points, SSIM by the independent tool; `last` counts the last frame alone."""
    if last:
        true, made = [true[0], *true[-1:]], [true[0], *made[-1:]]
        found = tool("face_measures").compare(true, made, step=1)
        return 2 * found["l1"], 2 * found["akd"], 2 * found["ssim"] - 1
    found = tool("face_measures").compare(true, made, step=1)
    return found["l1"], found["akd"], found["ssim"]


def _regional(true: list[NDArray[np.uint8]], made: list[NDArray[np.uint8]]) -> dict[str, float]:
    """L1 in [0, 1] of each region of the true frames, over the whole picture."""
    total, count = dict.fromkeys(PICTURE_REGIONS, 0.0), dict.fromkeys(PICTURE_REGIONS, 0.0)
    for a, b in zip(true, made, strict=True):
        found = find_faces(a)
        if not found:
            continue
        apart = np.abs(a.astype(float) - b).mean(axis=2) / 255
        for name, mask in _regions(a, found[0]).items():
            total[name] += float(apart[mask].sum())
            count[name] += float(mask.sum())
    return {name: total[name] / max(count[name], 1) for name in PICTURE_REGIONS}


def _regions(rgb: NDArray[np.uint8], mesh: NDArray[np.float32]) -> dict[str, NDArray[np.bool_]]:
    def hull(vertices: Sequence[int], grow: float) -> NDArray[np.bool_]:
        mask = np.zeros(rgb.shape[:2], np.uint8)
        cv2.fillConvexPoly(mask, cv2.convexHull(mesh[list(vertices), :2].round().astype(np.int32)), 1)
        side = 2 * round(grow) + 1
        return np.asarray(cv2.dilate(mask, np.ones((side, side), np.uint8)) > 0)

    unit = float(eye_distance(mesh[:, :2]))
    face, person = hull(FACE_OVAL, 0), person_confidence(rgb) > 0.5
    return {
        "face": face,
        "mouth": hull(LIPS_OUTER, 0.06 * unit),
        "eyes": hull(RIGHT_EYE, 0.08 * unit) | hull(LEFT_EYE, 0.08 * unit),
        "hair": person & ~face,
        "background": ~person & ~face,
    }


def _shown(values: Sequence[float | None], digits: Sequence[int]) -> list[str]:
    return ["lost" if v is None else f"{v:.{d}f}" for v, d in zip(values, digits, strict=True)]


def _save(pictures: Path | None, name: str, *rows: list[NDArray[np.uint8]]) -> None:
    """A contact sheet: the rows under each other, up to eight moments side by side."""
    if pictures is None:
        return
    sheet = contact_sheet([Row(evenly(row, SHEET_COLUMNS)) for row in rows], max_width=SHEET_WIDTH_PIXELS)
    write_sheet(pictures / f"{name}.png", sheet)
