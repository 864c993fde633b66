"""Photo Wake-Up (Weng, Curless, Kemelmacher-Shlizerman; CVPR 2019), stage by stage."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.character.drawing.flat_character import close_drawing
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.film.background import Background, fill_background
from engine.character.film.cast_shadow import ground_shadow
from engine.character.film.film import DEFAULT_VIDEO_PIXELS, cast_of, film, film_size
from engine.character.film.findings import character_names, write_findings
from engine.character.film.lit import lit_picture
from engine.character.film.motions import motion_in_use
from engine.character.film.person import Person
from engine.character.hybrid.hybrid import make_hybrid
from engine.character.hybrid.suited_surface import suited_surface
from engine.character.options import CharacterOptions
from engine.character.parts.unseen_limbs import with_limbs_hidden
from engine.character.rig.fewer_triangles import fewer_triangles
from engine.character.rig.left_out import warn_of_silhouette
from engine.character.rig.measures import measure, picture_camera
from engine.character.shell.extremities import with_relaxed_hands
from engine.character.shell.shell import make_shell
from engine.character.stages import (
    build_mesh,
    fit_drawn,
    fit_template,
    label,
    label_drawn,
    make_character,
    make_drawn,
    make_headed,
    make_headed_character,
    make_hybrid_character,
    make_shell_character,
)
from engine.errors import InputError
from engine.export.gltf.glb import TEXTURE_JPEG_QUALITY, CharacterModel, write_glb
from engine.export.gltf.vrm import VrmMeta, write_vrm
from engine.export.still import write_first_impression, write_still
from engine.export.usdz import write_usdz
from engine.export.videos.animated_gif import MAX_GIF_SIDE_PIXELS
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.kind import Given
from engine.media.image import over_white, write_image
from engine.motion.clip import Clip
from engine.motion.retargeting.joint_map import lost_warning
from engine.perception.masks.matting_network import matting_model
from engine.render.lighting.ground_shadow import GroundShadow
from engine.render.scene.character import film_cast
from engine.run import Run
from engine.run_report import write_report

STAGES = {
    "find_figure": 1.0,
    "cut_out": 2.0,
    "fit_template": 1.0,
    "label_parts": 2.0,
    "build_mesh": 3.0,
    "fill_background": 1.0,
    "make_character": 2.0,
    "write_character": 2.0,
    "animate": 8.0,
    "measure": 0.5,
}
"""The stages and their usual share of the time."""

STAGES_PER_PERSON = ("cut_out", "fit_template", "label_parts", "build_mesh", "make_character", "measure")
"""The stages that come once for each person."""
MAX_ANIMATED_PEOPLE = 6
"""People who are woken together."""
MAX_GLB_BYTES = 10_000_000
"""Of a character's GLB; levels of detail are files of their own."""
SKIPPED_REFUSALS = ("not_full_body", "person_too_small", "person_lying")
"""Of all, those who are refused for this stay in the picture."""


def wake_up(inputs: Mapping[str, Given], options: CharacterOptions, out: Path, run: Run) -> None:
    """Make a character of the person in `inputs["photo"]`, or of each; leaves the artifacts of the contract in `out`."""
    photo, motion, mask, label_map = (_file(inputs, name) for name in ("photo", "motion", "mask", "labels"))
    assert photo is not None
    if options.person_index == "all" and (mask is not None or label_map is not None):
        raise InputError(
            "one_outline_for_all",
            "A mask and a label map are of one person: say whose they are by person_index.",
            ("person_index", "mask", "labels"),
        )
    run.plan(STAGES)
    source = motion_in_use(motion, options.motion_clip, options.motion_joints, run.warn)  # a wrong one is told at once
    figures = find_figures(photo, options, run)
    figure = figures[0]
    if len(figures) > 1:
        run.plan(STAGES, dict.fromkeys(STAGES_PER_PERSON, len(figures)))
    for early in write_first_impression(out, figure.rgb, figure.alpha, run.mark_synthetic):
        run.publish(early)
    figures, silhouettes = cut_all_out(figures, mask, options, run)
    figure = figures[0]
    background = run.beside("fill_background", fill_background, figure, silhouettes)
    people = [
        reconstruct(one, silhouette, label_map, options, run)
        for one, silhouette in zip(figures, silhouettes, strict=True)
    ]
    with run.timed("write_character"):
        for person in people:
            person.act(options, source, people[0].character)
        if source and (lost := lost_warning(source, people[0].played.joints)):
            run.warn("motion_joints_unmapped", lost)
        for name, person in zip(character_names(people), people, strict=True):
            write_character(out, name, person, options, run)
        write_findings(out, people)
    filled = background()
    write_image(out / "background.png", filled.rgb)
    shadow = ground_shadow(filled.shadow, people[0].character, people[0].fitted)
    write_stills(out, people, filled.rgb, shadow, options, run)
    animation, frames = write_film(out, people, filled, shadow, options, run)
    quality = [measure_character(one, run) for one in people]
    joints = dict(people[0].played.joints)
    write_report(
        out / "report.json",
        "character",
        run,
        inputs={
            "size": [figure.rgb.shape[1], figure.rgb.shape[0]],
            "fps": options.fps,
            "frames": frames,
            "animation": animation,
            "people": np.round(figure.people / np.tile(figure.scale, 2), 1).tolist(),
            "person": options.person_index if options.person_index == "all" else figure.index,
        }
        | ({"motion_joints": joints} if joints else {})
        | ({"motion_skeleton": source.skeletons[0]} if source and source.skeletons else {}),
        quality=quality[0],
        more={
            "woken": [
                {"name": name, "person": person.figure.index, "quality": measured}
                for name, person, measured in zip(character_names(people), people, quality, strict=True)
            ]
        },
    )


def find_figures(photo: Path, options: CharacterOptions, run: Run) -> list[Figure]:
    """The one who is meant, or all. Of all, those of whom too little is seen stay in the picture."""
    placed = tuple((name, x, y) for name, (x, y) in sorted(options.joints.items()))

    def find(index: int | None) -> Figure:
        choice = Choice(options.person_box, None if options.person_box else index, placed)
        return run.stage("find_figure", find_figure, photo, choice, options.partial, run.limits, run.warn)

    if options.person_index != "all":
        return [find(options.person_index)]
    figures: list[Figure] = []
    refused: list[InputError] = []
    for index in range(MAX_ANIMATED_PEOPLE):
        if figures and index >= len(figures[0].people):
            break
        try:
            figures.append(find(index))
        except InputError as error:
            if refused and error.code == "person_index_out_of_range":
                break
            if error.code not in SKIPPED_REFUSALS:
                raise
            refused.append(error)
            run.warn("person_left_out", f"Person {index + 1} stays in the picture: {error.detail}")
    if not figures:
        raise refused[0]
    if len(figures[0].people) > MAX_ANIMATED_PEOPLE:
        run.warn(
            "person_left_out",
            f"Of {len(figures[0].people)} people the {MAX_ANIMATED_PEOPLE} largest walk out together.",
        )
    return figures


def cut_all_out(
    figures: Sequence[Figure], mask: Path | None, options: CharacterOptions, run: Run
) -> tuple[list[Figure], tuple[Silhouette, ...]]:
    """The figures whose outlines are found, and these. Of several, those whose are not stay in the picture."""
    model = matting_model(os.environ)
    cut = (mask, options.mask_strokes, run.limits, model, model and model.file.sha256, run.warn)
    found: list[tuple[Figure, Silhouette]] = []
    refused: list[InputError] = []
    for figure in figures:
        try:
            found.append((figure, run.stage("cut_out", cut_out, figure, *cut)))
        except InputError as error:
            if len(figures) == 1 or error.code != "no_person":
                raise
            refused.append(error)
            run.warn("person_left_out", f"Person {figure.index + 1} stays in the picture: {error.detail}")
    if not found:
        raise refused[0]
    return [figure for figure, _ in found], tuple(silhouette for _, silhouette in found)


def reconstruct(
    figure: Figure, silhouette: Silhouette, label_map: Path | None, options: CharacterOptions, run: Run
) -> Person:
    """From the mask to the character."""
    if figure.drawn:
        return reconstruct_drawing(figure, silhouette, label_map, options, run)
    fitted = run.stage("fit_template", fit_template, figure, silhouette)
    given = (label_map, options.label_strokes, run.limits, run.warn)
    labels = run.stage("label_parts", label, figure, silhouette, fitted, *given)
    if (labels.hidden >= 0).any():
        run.warn(
            "hand_in_pocket", "A hand is in a pocket, or behind cloth: the template's is shown where it comes out."
        )
    fitted = with_limbs_hidden(fitted, silhouette.camera(fitted.picture_camera()), labels, run.warn)
    painted = (options.triangles, options.back_texture)
    surface = options.surface
    if surface == "auto" and suited_surface(silhouette, fitted, labels) == "hybrid":
        surface = "hybrid"
    if surface in ("hybrid", "shell"):
        fitted = with_relaxed_hands(fitted)
    found = (figure, silhouette, fitted, labels)
    if surface == "auto":
        headed = run.stage("build_mesh", make_headed, *found)
        return Person(*found, run.stage("make_character", make_headed_character, *found, headed, *painted))
    if surface == "shell":
        shell = run.stage("build_mesh", make_shell, *found)
        return Person(*found, run.stage("make_character", make_shell_character, *found, shell, *painted))
    if surface == "hybrid":
        hybrid = run.stage("build_mesh", make_hybrid, *found)
        return Person(*found, run.stage("make_character", make_hybrid_character, *found, hybrid, *painted))
    mesh = run.stage("build_mesh", build_mesh, *found)
    return Person(*found, run.stage("make_character", make_character, *found, mesh, *painted))


def reconstruct_drawing(
    figure: Figure, silhouette: Silhouette, label_map: Path | None, options: CharacterOptions, run: Run
) -> Person:
    """From the mask of a drawing to the character: a flat cut-out in its own proportions."""
    fitted = run.stage("fit_template", fit_drawn, figure, silhouette)
    given = (label_map, options.label_strokes, run.limits)
    labels = run.stage("label_parts", label_drawn, figure, silhouette, *given)
    mesh = run.stage("build_mesh", close_drawing, figure, silhouette, labels)
    character = run.stage("make_character", make_drawn, figure, silhouette, fitted, mesh, options.triangles)
    return Person(figure, silhouette, fitted, labels, character)


def measure_character(person: Person, run: Run) -> dict[str, float]:
    """What the method can say of the result; what is missing of the outline is warned of."""
    figure, silhouette, fitted, character = person.figure, person.silhouette, person.fitted, person.character
    measured = run.stage("measure", measure, figure, silhouette, fitted, character, stored=False)
    warn_of_silhouette(measured.figures["silhouette_iou"], measured.left_out, run.warn)
    return measured.figures


def write_character(out: Path, name: str, person: Person, options: CharacterOptions, run: Run) -> None:
    """The character in all formats that are wanted, and in all levels of detail."""
    mesh, marked = person.character.mesh, run.mark_synthetic
    write_small_glb(out / f"{name}.glb", mesh, person.played.all, run)
    for level in range(1, options.levels + 1):
        coarser = fewer_triangles(person.character, len(mesh.triangles) // 4**level)
        write_small_glb(out / f"{name}-lod{level}.glb", coarser, person.played.all, run)
    write_usdz(out / f"{name}.usdz", mesh, person.played.film, synthetic=marked)
    if options.vrm:
        write_vrm(
            out / f"{name}.vrm",
            CharacterModel(mesh),
            VrmMeta(name=name, authors=(options.vrm_author,)),
            synthetic=marked,
        )


def write_stills(
    out: Path,
    people: Sequence[Person],
    plate: NDArray[np.uint8],
    shadow: GroundShadow,
    options: CharacterOptions,
    run: Run,
) -> None:
    """`posed.png`, the picture with everybody in the pose that they start from, and `lit.png` if that is asked for."""
    first = people[0]
    camera = picture_camera(first.character, first.fitted, (plate.shape[0], plate.shape[1]))
    cast = cast_of([(person.character, person.start) for person in people])
    posed = next(film_cast(cast, lambda second: camera, lambda camera: plate, shadow))
    write_still(out / "posed.png", posed, run.mark_synthetic)
    if options.lit:
        try:
            write_still(out / "lit.png", lit_picture(cast, camera, plate), run.mark_synthetic)
        except InputError as without_gl:
            run.warn(without_gl.code, without_gl.detail)


def write_film(
    out: Path,
    people: Sequence[Person],
    background: Background,
    shadow: GroundShadow,
    options: CharacterOptions,
    run: Run,
) -> tuple[str, int]:
    """The animation, and `poster.jpg` from its first third; returns the animation's name and how many frames it has."""
    plate = background.rgb
    longest = MAX_GIF_SIDE_PIXELS if options.format == "gif" else DEFAULT_VIDEO_PIXELS
    size = film_size((plate.shape[1], plate.shape[0]), options.size, longest)
    name = "animation." + {"png": "zip"}.get(options.format, options.format)
    acting = [(person.character, person.played.film) for person in people]
    frames = max(len(clip.rotations) for _, clip in acting)
    alone = background.empty and options.format != "mp4"
    with (
        run.timed("animate"),
        VideoWriter(VideoTarget(out / name, size, options.fps, options.format, synthetic=run.mark_synthetic)) as writer,
    ):
        for index, frame in enumerate(film(acting, people[0].fitted, plate, shadow, options.camera, size, alone)):
            alpha = frame[..., 3] / np.float32(255) if alone else None
            writer.write(frame[..., :3], alpha)
            if index == frames // 3:
                write_still(out / "poster.jpg", over_white(frame[..., :3], alpha), run.mark_synthetic)
            run.tick((index + 1) / frames)
    return name, frames


def write_small_glb(path: Path, mesh: SkinnedMesh, clips: Sequence[Clip], run: Run) -> None:
    """A GLB of at most `MAX_GLB_BYTES`; the report says what that took, or that it was not to be had."""
    written = write_glb(
        path, CharacterModel(mesh, clips), synthetic=run.mark_synthetic, most=MAX_GLB_BYTES, check=run.check
    )
    if written.size > MAX_GLB_BYTES:
        run.warn(
            "glb_too_large",
            f"{path.name} has {written.size / 1e6:.1f} MB, however its texture is written; fewer triangles help, or a shorter motion.",
        )
    elif (written.smaller, written.quality) != (1, TEXTURE_JPEG_QUALITY):
        size = f"1/{written.smaller} of its width and height" if written.smaller > 1 else "its full size"
        run.warn(
            "texture_reduced",
            f"The texture of {path.name} has {size}, at JPEG quality {written.quality}: the file would have had more than"
            f" {MAX_GLB_BYTES / 1e6:.0f} MB.",
        )


def _file(inputs: Mapping[str, Given], name: str) -> Path | None:
    given = inputs.get(name)
    assert given is None or isinstance(given, Path)
    return given
