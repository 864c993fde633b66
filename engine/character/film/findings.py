"""What was found, to be looked at and corrected: `mask.png`, `labels.png`, `skeleton.json`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.placed_joints import PLACEABLE_JOINTS
from engine.character.figure.strokes import LABEL_COLOURS
from engine.character.film.film import WALL_BEHIND_METRES
from engine.character.film.person import Person
from engine.character.rig.measures import picture_camera
from engine.media.image import write_image
from engine.motion.kinematics import joint_places
from engine.perception.pose.body import BODY_LANDMARKS


def write_findings(out: Path, people: Sequence[Person]) -> None:
    """Write them: mask and labels of all who were woken, the skeleton of the first, and each of them as `woken`."""
    alpha = np.max([person.silhouette.alpha for person in people], axis=0)
    write_image(out / "mask.png", np.repeat(np.round(alpha * 255).astype(np.uint8)[..., None], 3, 2))
    first = people[0]
    height, width = first.figure.rgb.shape[:2]
    shown = np.zeros((height, width, 3), np.uint8)
    for person in reversed(people):
        back = np.asarray(cv2.invertAffineTransform(person.silhouette.to_grid))
        coloured = LABEL_COLOURS[person.labels.labels.astype(int)]
        own = cv2.warpAffine(coloured, back, (width, height), flags=cv2.INTER_NEAREST)
        shown = np.asarray(np.where(own.any(-1, keepdims=True), own, shown), np.uint8)
    write_image(out / "labels.png", shown)
    found = {
        "size": list(first.figure.original),
        **_skeleton(first),
        "camera": {
            "eye": np.round(first.character.eye, 5).tolist(),
            "focal": round(first.fitted.camera.focal, 3),
            "centre": list(first.fitted.camera.centre),
            "size": [width, height],
            "wall": WALL_BEHIND_METRES,
        },
        "woken": woken(people),
    }
    (out / "skeleton.json").write_text(json.dumps(found) + "\n")


def woken(people: Sequence[Person]) -> list[dict[str, Any]]:
    """Who each character is, in the order of their files: the file's name, which of the people found, and the place of
    its origin in the world of the first, metres. One camera took them all. On level ground y is 0; it is not where
    somebody stands on something, or is smaller than they seem. And the skeleton of each."""
    eye = people[0].character.eye
    return [
        {
            "name": name,
            "person": person.figure.index,
            "place": np.round(eye - person.character.eye, 5).tolist(),
            **_skeleton(person),
        }
        for name, person in zip(character_names(people), people, strict=True)
    ]


def character_names(people: Sequence[Person]) -> list[str]:
    """The names of their files, without the ending."""
    return ["character", *(f"character-{number}" for number in range(2, len(people) + 1))]


def _skeleton(person: Person) -> dict[str, Any]:
    """Landmarks as they were seen and the character's joints as they were fitted, both in pixels of the original
    picture."""
    figure, fitted, character = person.figure, person.fitted, person.character
    height, width = figure.rgb.shape[:2]

    def original(points: NDArray[np.floating]) -> list[list[float]]:
        found: list[list[float]] = np.round((points + 0.5) / figure.scale - 0.5, 1).tolist()
        return found

    seen = original(figure.points)
    skeleton = character.mesh.skeleton
    camera = picture_camera(character, fitted, (height, width))
    fitted_at = original(camera.project(joint_places(skeleton, character.pictured)[0])[:, :2])
    above = [None if parent < 0 else skeleton.names[parent] for parent in skeleton.parents]
    return {
        "joints": {
            name: {
                "place": seen[BODY_LANDMARKS.index(name)],
                "confidence": round(float(figure.confidence[BODY_LANDMARKS.index(name)]), 3),
            }
            for name in PLACEABLE_JOINTS
        },
        "fitted": {
            name: {"place": place, "parent": parent}
            for name, place, parent in zip(skeleton.names, fitted_at, above, strict=True)
        },
        "reprojection": round(fitted.fit.reprojection / float(figure.scale.mean()), 2),
    }
