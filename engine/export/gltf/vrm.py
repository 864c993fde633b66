"""Characters out as VRM 1.0: a GLB that says which joint is which part of a human, and what may be done with it.

Specification: VRM Consortium, VRMC_vrm-1.0 (humanoid, meta, firstPerson, lookAt, expressions).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from engine.export.gltf.glb import TEXTURE_JPEG_QUALITY, CharacterModel, build_glb, joint_names, jpeg, save_glb
from engine.export.gltf.vrm_expressions import LOOK_EXPRESSIONS, Expression, expressions_document
from engine.geometry.rigging.skinned_mesh import SkinnedMesh

LICENCE_URL = "https://vrm.dev/licenses/1.0/"

TRUNK_BONES = {
    "hips": "Hips",
    "spine": "Spine",
    "chest": "Spine1",
    "upperChest": "Spine2",
    "neck": "Neck",
    "head": "Head",
}

LIMB_BONES = {
    **{"Shoulder": "Shoulder", "UpperArm": "Arm", "LowerArm": "ForeArm", "Hand": "Hand"},
    **{"UpperLeg": "UpLeg", "LowerLeg": "Leg", "Foot": "Foot", "Toes": "ToeBase"},
    **{"ThumbMetacarpal": "HandThumb1", "ThumbProximal": "HandThumb2", "ThumbDistal": "HandThumb3"},
    **{
        f"{finger}{part}": f"Hand{ours}{number}"
        for finger, ours in (("Index", "Index"), ("Middle", "Middle"), ("Ring", "Ring"), ("Little", "Pinky"))
        for number, part in enumerate(("Proximal", "Intermediate", "Distal"), 1)
    },
}
"""VRM's bones of one side, without `left` or `right`, and Mixamo's, without `Left` or `Right`."""

OPTIONAL_BONES = {"leftEye": "LeftEye", "rightEye": "RightEye", "jaw": "Jaw"}
"""Bones that not every skeleton has."""

REQUIRED_BONES = (
    *("hips", "spine", "head"),
    *(
        f"{side}{bone}"
        for side in ("left", "right")
        for bone in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
    ),
)
"""Bones without which there is no VRM humanoid."""

MAX_EYE_TURN_DEGREES = {"HorizontalInner": 30.0, "HorizontalOuter": 30.0, "VerticalDown": 25.0, "VerticalUp": 25.0}
"""Degrees that eyes turn before the head does."""


@dataclass(frozen=True)
class VrmMeta:
    """Whose the character is and what may be done with it; by default as little as VRM knows.

    `licence_url`: of the licence of all VRM files; `other_licence_url`: of one that applies besides.
    """

    name: str
    authors: tuple[str, ...]
    version: str = "1.0"
    copyright: str | None = None
    contact: str | None = None
    licence_url: str = LICENCE_URL
    other_licence_url: str | None = None
    who: Literal["onlyAuthor", "onlySeparatelyLicensedPerson", "everyone"] = "onlyAuthor"
    commercial: Literal["personalNonProfit", "personalProfit", "corporation"] = "personalNonProfit"
    modification: Literal["prohibited", "allowModification", "allowModificationRedistribution"] = "prohibited"
    credit: Literal["required", "unnecessary"] = "required"
    redistribution: bool = False
    references: tuple[str, ...] = field(default=())


def write_vrm(
    path: Path,
    model: CharacterModel,
    meta: VrmMeta,
    *,
    quality: int = TEXTURE_JPEG_QUALITY,
    expressions: Mapping[str, Expression] | None = None,
    look_at: Literal["bone", "expression"] = "bone",
    synthetic: bool = True,
) -> None:
    """Write a character as VRM 1.0; the file appears under its name when it is whole.

    Parameters
    ----------
    model : without levels of detail, of which VRM knows nothing; its clips become animations of the GLB, which viewers of
        VRM may pass over.
    expressions : by name, VRM's own (`engine.export.gltf.vrm_expressions.PRESET_NAMES`) or others, mixed of the model's morph targets.
    look_at : whether the eyes look about by their joints or by the expressions `lookUp`, `lookDown`, `lookLeft` and
        `lookRight`.

    `quality` and `synthetic` are as of `engine.export.gltf.glb.write_glb`.

    Raises ValueError where the skeleton lacks one of `REQUIRED_BONES`, or `meta` names no author. Also where
    expressions do not fit the morph targets, or lack those by which the eyes should look about, and where the model has
    levels of detail.
    """
    if not meta.name or not meta.authors:
        raise ValueError("a VRM needs a name and an author")
    if model.levels:
        raise ValueError("a VRM has no levels of detail")
    texture = jpeg(model.mesh.texture, quality, synthetic)
    said = expressions or {}
    if look_at == "expression" and not set(LOOK_EXPRESSIONS) <= set(said):
        raise ValueError(f"to look about by expressions takes {', '.join(LOOK_EXPRESSIONS)}")
    gltf = build_glb(model, texture, name=meta.name, synthetic=synthetic)
    shown = next(index for index, node in enumerate(gltf.nodes) if node.mesh is not None)
    gltf.extensions = {
        "VRMC_vrm": {
            "specVersion": "1.0",
            "meta": _meta(meta),
            "humanoid": {"humanBones": human_bones(joint_names(gltf))},
            "firstPerson": {"meshAnnotations": [{"node": shown, "type": "auto"}]},
            "lookAt": _look_at(model.mesh, look_at),
        }
    }
    if said:
        gltf.extensions["VRMC_vrm"]["expressions"] = expressions_document(
            said, [morph.name for morph in model.morphs], shown
        )
    gltf.extensionsUsed = [*gltf.extensionsUsed, "VRMC_vrm"]
    save_glb(path, b"".join(gltf.save_to_bytes()))


def human_bones(names: Sequence[str]) -> dict[str, dict[str, int]]:
    """VRM's map of human bones to nodes, for joints by their Mixamo names: `{"hips": {"node": 0}, ...}`.

    Raises ValueError where one of `REQUIRED_BONES` is missing.
    """
    table = {**TRUNK_BONES, **OPTIONAL_BONES}
    for side, ours in (("left", "Left"), ("right", "Right")):
        table |= {f"{side}{bone}": f"{ours}{joint}" for bone, joint in LIMB_BONES.items()}
    if "Spine1" not in names and "Spine2" in names:  # the upper chest wants a chest below it
        table |= {"chest": "Spine2", "upperChest": ""}
    found = {bone: {"node": names.index(joint)} for bone, joint in table.items() if joint in names}
    missing = [bone for bone in REQUIRED_BONES if bone not in found]
    if missing:
        raise ValueError(f"the skeleton has no {', '.join(missing)}")
    return found


def _meta(meta: VrmMeta) -> dict[str, Any]:
    said = {
        "name": meta.name,
        "version": meta.version,
        "authors": list(meta.authors),
        "copyrightInformation": meta.copyright,
        "contactInformation": meta.contact,
        "references": list(meta.references) or None,
        "licenseUrl": meta.licence_url,
        "otherLicenseUrl": meta.other_licence_url,
        "avatarPermission": meta.who,
        "commercialUsage": meta.commercial,
        "creditNotation": meta.credit,
        "modification": meta.modification,
        "allowRedistribution": meta.redistribution,
        "allowExcessivelyViolentUsage": False,
        "allowExcessivelySexualUsage": False,
        "allowPoliticalOrReligiousUsage": False,
        "allowAntisocialOrHateUsage": False,
    }
    return {key: value for key, value in said.items() if value is not None}


def _look_at(mesh: SkinnedMesh, by: Literal["bone", "expression"]) -> dict[str, Any]:
    """Where a first-person camera sits, between the eyes if the skeleton has them, else in the middle of the head. Also
    how far the eyes go when they look aside: joints all the way to what they look at, up to `MAX_EYE_TURN_DEGREES`, or
    as far as the expressions go."""
    skeleton = mesh.skeleton
    head = skeleton.heads[skeleton.index("Head")]
    if "LeftEye" in skeleton.names and "RightEye" in skeleton.names:
        eyes = (skeleton.heads[skeleton.index("LeftEye")] + skeleton.heads[skeleton.index("RightEye")]) / 2
        offset = eyes - head
    else:
        offset = (mesh.vertices[:, 1].max() - head[1]) * np.array([0, 0.5, 0])
    return {
        "type": by,
        "offsetFromHeadBone": [float(value) for value in offset],
        **{
            f"rangeMap{name}": {"inputMaxValue": reach, "outputScale": reach if by == "bone" else 1.0}
            for name, reach in MAX_EYE_TURN_DEGREES.items()
        },
    }
