"""Characters against the truth: masks, shapes and joints of people of whom everything is known.

    python -m benchmarks.character_truth [--only WORD] [--sheet PICTURE.png]

The project's rasteriser draws the scans of the test media, and the template dressed, into photographs. "IoU" is of the
mask that is found with the true coverage above one half. Shapes are compared, at a body height of 1.8 m, after the
similarity that fits best, in centimetres: "chamfer" is the mean of both directions, "surface" the way from the true
surface to the one made, "normals" degrees. "template" is the bare fitted template; "warped depth" is the character whose
depth is the template's own, warped, in the place of the depth that follows from its warped normals (figure 3).
"Joints" are the template's, compared after the best similarity; "landmarks off" is the fit's reprojection error.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from unittest.mock import patch

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter1d

from benchmarks.character_figures.truth_sheet import write_truth_sheet
from benchmarks.known_truth.comparison import Comparison, MadeSurfaces
from benchmarks.known_truth.dressed_template import DRESSED_LOOKS, dress
from benchmarks.known_truth.known_person import PERSON_PICTURE_SIZE, KnownPicture, Person, draw_into
from benchmarks.known_truth.known_places import places
from benchmarks.known_truth.scanned_bodies import read_scan
from benchmarks.known_truth.surface_distance import align, compare, sample_outside
from benchmarks.presentation.tables import machine, table
from benchmarks.shared_media import media
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.fit.template_maps import SideMaps
from engine.character.parts.unseen_limbs import with_limbs_hidden
from engine.character.rig.measures import pose
from engine.character.stages import build_mesh, fit_template, label, make_character
from engine.character.surface import layers
from engine.character.surface.part_surface import OUTLINE_DEPTH_SMOOTHING_PIXELS, Surface, Warp, filled, part_surface
from engine.errors import InputError
from engine.geometry.registration.rigid import fit_similarity
from engine.geometry.rigging.skinning import bone_transforms
from engine.imaging.masks.mask_pieces import rows_apart
from engine.media.limits import Limits

BODY_HEIGHT_METRES = 1.8
"""Metres of height to which bodies are scaled before distances are taken."""
PERSON_TURN_DEGREES = 25.0
"""By which some people are turned from the camera."""
CHARACTER_TRIANGLES = 60_000
"""Triangles of a character, as it is written unless asked for otherwise."""
FINGER_JOINT_NAMES = ("Thumb", "Index", "Middle", "Ring", "Pinky")
"""Fingers, as the names of their joints have them."""


def people() -> Iterator[tuple[Person, str]]:
    """The scans from the front and from a side, and the dressed template, one of them turned too; and where they stand."""
    man = read_scan(media("scans3d/body_male02/male02.obj"), 1)
    soldier = read_scan(media("scans3d/body_soldier/soldier.glb"), -1)
    yield from ((man, "garage"), (man.turned(PERSON_TURN_DEGREES), "street"))
    yield from ((soldier, "street"), (soldier.turned(-PERSON_TURN_DEGREES), "yard"), (soldier, "garage door"))
    dressed = [dress(look) for look in DRESSED_LOOKS]
    yield from zip(dressed, ("garage", "street", "garage door", "yard", "garage"), strict=True)
    yield dressed[0].turned(-PERSON_TURN_DEGREES), "street"


def examine(known: KnownPicture, place: str) -> Comparison:
    """Make a character of the picture as any user's, and compare it with who was drawn."""
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        photo = Path(folder) / "photo.png"
        Image.fromarray(known.rgb).save(photo)
        figure = find_figure(photo, Choice(), False, Limits(), lambda code, message: None)
    silhouette = cut_out(figure, None, (), Limits(), None, None, lambda code, message: None)
    fitted = fit_template(figure, silhouette)
    surfaces = build_surfaces(figure, silhouette, fitted)
    found, true = silhouette.alpha > 0.5, known.alpha > 0.5
    scale = BODY_HEIGHT_METRES / known.person.height
    truth = sample_outside(known.person.vertices * scale, known.person.triangles)
    distances, aligned = [], []
    for vertices, triangles in (surfaces.made, surfaces.by_depth, surfaces.template):
        scaled = vertices * (BODY_HEIGHT_METRES / np.ptp(vertices[:, 1]))
        seen = sample_outside(scaled, triangles)
        move = align(seen, truth)
        distances.append(compare(seen.moved(move), truth))
        aligned.append(move(scaled))
    return Comparison(
        known=known,
        place=place,
        iou=float((found & true).sum() / (found | true).sum()),
        distances=(distances[0], distances[1], distances[2]),
        joints=None if known.person.joints is None else joint_errors(fitted, known.person.joints),
        reprojection=fitted.fit.reprojection / max(rows_apart(true), 1),
        seconds=time.perf_counter() - start,
        aligned=(aligned[0], aligned[2]),
        surfaces=surfaces,
        mask=silhouette.alpha,
    )


def build_surfaces(figure: Figure, silhouette: Silhouette, fitted: FittedBody) -> MadeSurfaces:
    """The character posed by its clip `pictured`, the mesh by warped depth, and the fitted template."""
    labels = label(figure, silhouette, fitted, None, (), Limits(), lambda code, message: None)
    fitted = with_limbs_hidden(fitted, silhouette.camera(fitted.picture_camera()), labels, lambda code, message: None)
    mesh = build_mesh(figure, silhouette, fitted, labels)
    character = make_character(figure, silhouette, fitted, labels, mesh, CHARACTER_TRIANGLES, "mirror")
    with patch.object(layers, "part_surface", warped_depth):
        by_depth = build_mesh(figure, silhouette, fitted, labels)
    bare = pose_template(fitted, fitted.picture_camera(), load_human())
    return MadeSurfaces(
        (pose(character, character.pictured).astype(np.float64) - character.eye, character.mesh.triangles),
        (silhouette.camera(fitted.picture_camera()).to_metres(by_depth.vertices), by_depth.triangles),
        (fitted.picture_camera().to_metres(bare.vertices), bare.triangles),
    )


def warped_depth(
    mask: NDArray[np.bool_],
    warp: Warp,
    template: SideMaps,
    weights: NDArray[np.float32],
    bare: NDArray[np.bool_] | None = None,
) -> Surface:
    """`part_surface` with the template's depth looked up where the warp leads, and along the outline, where both have the
    same, that of the outline; normals are not looked at."""
    surface = part_surface(mask, warp, template, weights, bare)
    x, y = (np.ascontiguousarray(warp.places[..., k]) for k in range(2))
    source = template.depth[filled(warp, template).nearest]
    depth = cv2.remap(source, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    at, partners = warp.border.astype(int), warp.partners.astype(int)
    along = source[partners[:, 1], partners[:, 0]]
    depth[at[:, 1], at[:, 0]] = gaussian_filter1d(along, OUTLINE_DEPTH_SMOOTHING_PIXELS, mode="wrap")
    return Surface(np.where(mask, depth, np.nan).astype(np.float32), surface.weights)


def joint_errors(fitted: FittedBody, truth: NDArray[np.float64]) -> tuple[float, float]:
    """Mean and largest distance, centimetres, of the body's joints (no fingers) after the best similarity."""
    human, fit = load_human(), fitted.fit
    heads = human.space.joints(fit.coefficients)
    transforms = bone_transforms(human.rig.parents, heads, fit.rotations, fit.root_translation - heads[0])
    joints = np.einsum("jab,jb->ja", transforms[:, :3, :3], heads) + transforms[:, :3, 3]
    body = [k for k, name in enumerate(human.rig.names) if not any(finger in name for finger in FINGER_JOINT_NAMES)]
    off = 100 * np.linalg.norm(fit_similarity(joints[body], truth[body])(joints[body]) - truth[body], axis=1)
    return float(off.mean()), float(off.max())


def tables(results: Sequence[Comparison]) -> str:
    """All figures."""
    masks = [[r.known.person.name, r.place, f"{r.iou:.3f}"] for r in results]
    masks.append(["mean (goal 0.97)", "", f"{np.mean([r.iou for r in results]):.3f}"])
    shapes = [
        [r.known.person.name, *(f"{100 * d.chamfer:.2f}" for d in r.distances),
         *(f"{100 * d.to_surface:.2f}" for d in r.distances), *(f"{d.normals:.1f}" for d in r.distances)]
        for r in results
    ]  # fmt: skip
    means = np.array([[[100 * d.chamfer, 100 * d.to_surface, d.normals] for d in r.distances] for r in results]).mean(0)
    shapes.append(["mean (goal 2.5)", *(f"{v:.2f}" for v in means[:, 0]), *(f"{v:.2f}" for v in means[:, 1]),
                   *(f"{v:.1f}" for v in means[:, 2])])  # fmt: skip
    joined = [(r, r.joints) for r in results if r.joints is not None]
    fits = [[r.known.person.name, f"{j[0]:.1f}", f"{j[1]:.1f}", f"{100 * r.reprojection:.2f} %"] for r, j in joined]
    if joined:
        fits.append(["mean (goals 5, 1 %)", f"{np.mean([j[0] for _, j in joined]):.1f}", "",
                     f"{100 * np.mean([r.reprojection for r, _ in joined]):.2f} %"])  # fmt: skip
    kinds = ("character", "warped depth", "template")
    return "\n".join([
        table("Masks against known coverage", ["person", "place", "IoU"], masks),
        table("Shapes against the truth", ["person", *(f"chamfer, {kind}" for kind in kinds),
              *(f"surface, {kind}" for kind in kinds), *(f"normals, {kind}" for kind in kinds)], shapes),
        table("Fits against the truth", ["person", "joints, mean cm", "largest cm", "landmarks off"], fits),
    ])  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="people whose name contains this")
    parser.add_argument("--sheet", type=Path, help="write the pictures, with both surfaces from the side, here")
    asked = parser.parse_args()
    backgrounds, results = places(PERSON_PICTURE_SIZE), []
    for person, place in people():
        if asked.only not in person.name:
            continue
        try:
            results.append(examine(draw_into(person, backgrounds[place]), place))
        except InputError as error:
            print(f"{person.name}, {place}: {error.code}, left out of the means")
    if not results:
        raise SystemExit("nobody to measure")
    print(f"{machine()}; {sum(r.seconds for r in results) / len(results):.0f} s a person")
    print(tables(results))
    if asked.sheet is not None:
        write_truth_sheet(asked.sheet, results)


if __name__ == "__main__":
    main()
