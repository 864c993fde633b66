"""The fitted template alone against the truth, and against real pictures: how far pose, place and outline are off.

    python -m benchmarks.character_fit --store FOLDER [--only WORD] [--sheet PICTURE.png]

Rigged people (`benchmarks.scan_studio.people.rigged_people`) are drawn into photographs in known poses, by a level camera from afar and
by a telephone near by; real pictures are those of the test media. Figures and silhouettes are kept in `--store` and made where they
lack, which takes minutes; fitting to them is what is measured.

"arms", "forearms", "thighs" and "shins" are degrees between the true limb and the fitted one. "joints" are centimetres
between shoulders, elbows, wrists, knees and ankles and the true ones, with hips on hips and both at the picture's
scale. "feet" is how far the fitted soles end above the true ones of the same legs, as a share of the height (negative:
below). "IoU" is the overlap of the bare template with the person's true outline. Of real pictures "IoU" is with the
mask, "feet" from the lowest place of the mask at each foot (of both the worse), "landmarks" the root mean square
distance from perception's, as a share of the height.
"""

from __future__ import annotations

import argparse
import pickle
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks.character_figures.steps import options_for, pictures
from benchmarks.presentation.contact_sheet import Picture, Row, at_height, contact_sheet, write_sheet
from benchmarks.presentation.tables import machine, mean_row, table
from benchmarks.scan_studio.people.rigged_people import BONE_END_JOINTS
from benchmarks.scan_studio.photographed import Truth, cases, feet, photograph
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.stages import fit_template
from engine.errors import InputError
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skinning import bone_transforms, skin
from engine.imaging.masks.mask_pieces import bounding_box
from engine.media.limits import Limits
from engine.perception.pose.body import BODY_LANDMARKS
from engine.render.rasterisation.rasteriser import rasterise

JOINT_OF_LIMB = {"arms": "Arm", "forearms": "ForeArm", "thighs": "UpLeg", "shins": "Leg"}
COMPARED_JOINTS = ("Arm", "ForeArm", "Hand", "Leg", "Foot")
"""Joints of each side whose places are compared."""
FOOT_MARGIN_SHARE = 0.05
"""How far beside a foot's landmarks its own part of a mask may reach, as a share of the height."""
SHEET_HEIGHT_PIXELS = 420

Stages = tuple[Figure, Silhouette]


@dataclass(frozen=True)
class Laid:
    """A fitted template before its picture's camera.

    vertices : (V, 3) metres.
    joints : (3,) metres, by name.
    pixels : (V, 3).
    cover : (H, W) of the picture.
    soles : the lowest row of each foot, left and right.
    """

    vertices: NDArray[np.float32]
    joints: Mapping[str, NDArray[np.float64]]
    pixels: NDArray[np.float64]
    cover: NDArray[np.bool_]
    soles: tuple[float, float]


def lay(fitted: FittedBody) -> Laid:
    """The bare template as it is fitted."""
    human, fit = load_human(), fitted.fit
    rest, heads = human.space.vertices(fit.coefficients), human.space.joints(fit.coefficients)
    transforms = bone_transforms(human.rig.parents, heads, fit.rotations, fit.root_translation - heads[0])
    vertices = skin(rest, human.rig.bones, human.rig.weights, transforms)
    joints = np.einsum("jab,jb->ja", transforms[:, :3, :3], heads) + transforms[:, :3, 3]
    pixels = fitted.camera.project(vertices, np.float64)
    cover = rasterise(pixels, human.triangles, fitted.camera.size, perspective=True).triangle >= 0
    used = np.unique(human.triangles)
    left, right = feet(human.rig.names, human.rig.bones[used, 0])
    return Laid(
        vertices,
        dict(zip(human.rig.names, joints, strict=True)),
        pixels,
        cover,
        (float(pixels[used][left, 1].max()), float(pixels[used][right, 1].max())),
    )


def found(photo: Path) -> Stages:
    """Figure and silhouette of a picture, as the pipeline finds them."""
    asked = options_for(photo, {})
    placed = tuple((name, x, y) for name, (x, y) in sorted(asked.joints.items()))
    figure = find_figure(photo, Choice(None, None, placed), True, Limits(), lambda code, message: None)
    return figure, cut_out(figure, None, (), Limits(), None, None, lambda code, message: None)


def of_truth(fitted: FittedBody, truth: Truth) -> list[float | None]:
    """A row of the first table."""
    laid = lay(fitted)
    row: list[float | None] = []
    for joint in JOINT_OF_LIMB.values():
        off = []
        for side in SIDE_NAMES:
            first, end = f"{side}{joint}", BONE_END_JOINTS[f"{side}{joint}"]
            a, b = truth.joints[end] - truth.joints[first], laid.joints[end] - laid.joints[first]
            off.append(float(np.degrees(np.arccos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1)))))
        row.append(float(np.mean(off)))
    true_hips, hips = (_hips(joints) for joints in (truth.joints, laid.joints))
    scale = (fitted.camera.focal / hips[2]) / (truth.camera.focal / true_hips[2])
    away = [
        np.linalg.norm(scale * (laid.joints[f"{side}{joint}"] - hips) - (truth.joints[f"{side}{joint}"] - true_hips))
        for side in SIDE_NAMES
        for joint in COMPARED_JOINTS
    ]
    mask = truth.alpha > 0.5
    height = float(np.ptp(np.flatnonzero(mask.any(1))))
    soles = [100 * (true - own) / height for true, own in zip(truth.soles, laid.soles, strict=True)]
    return [
        *row,
        float(np.mean([value for value in row if value is not None])),
        100 * float(np.mean(away)),
        *soles,
        _iou(mask, laid.cover),
    ]


def _hips(joints: Mapping[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    return (joints["LeftUpLeg"] + joints["RightUpLeg"]) / 2


def of_picture(fitted: FittedBody, figure: Figure, silhouette: Silhouette) -> list[float | None]:
    """A row of the second table."""
    laid, mask = lay(fitted), silhouette.alpha > 0.5
    height = float(np.ptp(np.flatnonzero(mask.any(1))))
    off = [100 * (seen - own) / height for seen, own in zip(mask_soles(figure, mask), laid.soles, strict=True)]
    known = [value for value in off if np.isfinite(value)]
    worse = max(known, key=abs) if known else None
    return [_iou(mask, laid.cover), worse, 100 * fitted.fit.reprojection / height]


def mask_soles(figure: Figure, mask: NDArray[np.bool_]) -> tuple[float, float]:
    """The lowest row of a mask (H, W) at the left and the right foot, where perception has them; NaN where it has not, or the
    picture ends. Each pixel is of the nearer foot."""
    height = float(np.ptp(np.flatnonzero(mask.any(1))))
    rows, columns = np.nonzero(mask)
    away, sure = [], []
    for side in SIDE_NAMES:
        marks = [BODY_LANDMARKS.index(f"{side}{name}") for name in ("Ankle", "Heel", "FootIndex")]
        points = figure.points[marks].astype(np.float64)
        ends = np.concatenate([points, points.mean(0, keepdims=True), (points[1:2] + points[2:3]) / 2])
        away.append(np.min([np.hypot(columns - x, rows - y) for x, y in ends], axis=0))
        sure.append(float(figure.confidence[marks].min()) > 0.3)
    soles = []
    for one, other in ((0, 1), (1, 0)):
        own = (away[one] < away[other]) & (away[one] < FOOT_MARGIN_SHARE * height) & sure[one]
        lowest = float(rows[own].max()) if own.any() else np.nan
        soles.append(np.nan if lowest > mask.shape[0] - 3 else lowest)
    return soles[0], soles[1]


def _iou(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> float:
    return float((first & second).sum() / max((first | second).sum(), 1))


def overlay(figure: Figure, silhouette: Silhouette, fitted: FittedBody) -> Picture:
    """The template's outline over the person in the picture, its left limbs' joints red, its right ones' blue."""
    laid = lay(fitted)
    shown = figure.rgb.copy()
    wide = max(1, round(silhouette.alpha.shape[0] / 400))
    lines, _ = cv2.findContours(laid.cover.astype(np.uint8), cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(shown, lines, -1, (0, 255, 0), wide)
    for side, colour in zip(SIDE_NAMES, ((255, 0, 0), (0, 80, 255)), strict=True):
        for chain in (("Arm", "ForeArm", "Hand"), ("UpLeg", "Leg", "Foot", "ToeBase")):
            line = fitted.camera.project(np.stack([laid.joints[f"{side}{joint}"] for joint in chain]))[:, :2]
            cv2.polylines(shown, [np.rint(line).astype(np.int32)], False, colour, wide)
    rows, columns = bounding_box(silhouette.alpha > 0.5)
    rim = (rows.stop - rows.start) // 12
    whole = shown[max(0, rows.start - rim) : rows.stop + rim, max(0, columns.start - rim) : columns.stop + rim]
    return at_height(np.asarray(whole, np.uint8), SHEET_HEIGHT_PIXELS)


def stored(path: Path, make: Callable[[], object]) -> object:
    """What is kept in a file; made and kept where it lacks. A picture that is refused is kept as its error's code."""
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            made = make()
        except InputError as error:
            made = error.code
        path.write_bytes(pickle.dumps(made))
    return pickle.loads(path.read_bytes())


def made_truth(store: Path, case: tuple[str, str, str, str]) -> object:
    """Figure, silhouette and truth of a rigged person."""

    def make() -> tuple[Figure, Silhouette, Truth]:
        rgb, truth = photograph(*case)
        photo = store / "photo.png"
        Image.fromarray(rgb).save(photo)
        return *found(photo), truth

    return stored(store / "truth" / f"{', '.join(case[:3])}.pickle", make)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--store", type=Path, required=True)
    parser.add_argument("--only", default="", metavar="WORD")
    parser.add_argument("--sheet", type=Path)
    asked = parser.parse_args()
    print(machine())
    seconds: list[float] = []
    sheet: list[Row] = []

    def fit(name: str, figure: Figure, silhouette: Silhouette) -> FittedBody:
        started = time.process_time()
        fitted = fit_template(figure, silhouette)
        seconds.append(time.process_time() - started)
        sheet.append(Row([overlay(figure, silhouette, fitted)], name))
        return fitted

    head = ["", *JOINT_OF_LIMB, "limbs", "joints cm", "left foot %", "right foot %", "IoU"]
    digits: tuple[int, ...] = (0, 0, 0, 0, 1, 1, 1, 1, 3)
    rows: list[list[str]] = []
    values: list[list[float | None]] = []
    for case in cases(asked.only):
        made, name = made_truth(asked.store, case), f"{case[0]}: {case[1]}, {case[2]}"
        if isinstance(made, tuple):
            figure, silhouette, truth = made
            values.append(of_truth(fit(name, figure, silhouette), truth))
            rows.append(mean_row(name, values[-1:], digits))
        else:
            rows.append([name, str(made), *[""] * (len(head) - 2)])
    _report("Against the truth", head, rows, values, digits)
    head, digits = ["", "IoU", "feet %", "landmarks %"], (3, 1, 2)
    rows, values = [], []
    for photo in pictures():
        if asked.only not in photo.stem:
            continue
        kept = stored(asked.store / "pictures" / f"{photo.stem}.pickle", partial(found, photo))
        if isinstance(kept, tuple):
            figure, silhouette = kept
            values.append(of_picture(fit(photo.stem, figure, silhouette), figure, silhouette))
            rows.append(mean_row(photo.stem, values[-1:], digits))
        else:
            rows.append([photo.stem, str(kept), "", ""])
    _report("Against real pictures", head, rows, values, digits)
    if seconds:
        print(f"\n{np.mean(seconds):.2f} s of one core a picture, at most {max(seconds):.2f}")
    if asked.sheet and sheet:
        across = 8
        lines = [Row([one.pictures[0] for one in sheet[k : k + across]], ", ".join(one.title for one in sheet[k : k + across]))
                 for k in range(0, len(sheet), across)]  # fmt: skip
        write_sheet(asked.sheet, contact_sheet(lines, (SHEET_HEIGHT_PIXELS, SHEET_HEIGHT_PIXELS * 3 // 4)))


def _report(
    title: str,
    head: Sequence[str],
    rows: list[list[str]],
    values: list[list[float | None]],
    digits: Sequence[int],
) -> None:
    """A table with means, and below it those of sizes, without sign."""
    if not values:
        return
    sizes = [[None if value is None else abs(value) for value in row] for row in values]
    rows = [*rows, mean_row("mean", values, digits), mean_row("mean size", sizes, digits)]
    print(table(title, head, rows), flush=True)


if __name__ == "__main__":
    main()
