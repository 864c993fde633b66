"""A small motion file of a person, made by hand: arms swing while they stand."""

from __future__ import annotations

BONES = {
    "Hips": (None, (0, 95, 0)),
    "Spine": ("Hips", (0, 12, 0)),
    "Chest": ("Spine", (0, 20, 0)),
    "Neck": ("Chest", (0, 20, 0)),
    "Head": ("Neck", (0, 10, 0)),
    **{
        f"{side}{part}": (above and (above if above in ("Hips", "Chest") else side + above), (sign * x, y, z))
        for side, sign in (("Left", 1), ("Right", -1))
        for part, above, (x, y, z) in (
            ("Collar", "Chest", (4, 14, 0)),
            ("Arm", "Collar", (12, 0, 0)),
            ("ForeArm", "Arm", (27, 0, 0)),
            ("Hand", "ForeArm", (25, 0, 0)),
            ("UpLeg", "Hips", (9, -4, 0)),
            ("Leg", "UpLeg", (0, -42, 0)),
            ("Foot", "Leg", (0, -42, 0)),
            ("Toe", "Foot", (0, -6, 12)),
        )
    },
}
"""Each joint's parent and place from it, centimetres."""


def bvh(names: dict[str, str] | None = None, frames: int = 20) -> bytes:
    """The file; `names` calls joints something else."""
    called = {bone: (names or {}).get(bone, bone) for bone in BONES}
    order: list[str] = []

    def told(bone: str, depth: int) -> list[str]:
        order.append(bone)
        pad, parent = "  " * depth, BONES[bone][0]
        channels = "6 Xposition Yposition Zposition" if parent is None else "3"
        lines = [
            f"{pad}{'ROOT' if parent is None else 'JOINT'} {called[bone]}",
            f"{pad}{{",
            f"{pad}  OFFSET {' '.join(map(str, BONES[bone][1] if parent else (0, 0, 0)))}",
            f"{pad}  CHANNELS {channels} Zrotation Xrotation Yrotation",
        ]
        below = [one for one, (above, _) in BONES.items() if above == bone]
        lines += [line for one in below for line in told(one, depth + 1)]
        if not below:
            lines += [f"{pad}  End Site", f"{pad}  {{", f"{pad}    OFFSET 0 5 0", f"{pad}  }}"]
        return [*lines, f"{pad}}}"]

    hierarchy = told("Hips", 0)
    rows = []
    for frame in range(frames):
        swing = 40 * (frame / max(frames - 1, 1) - 0.5)
        turns = ["0 0 0" if bone != "LeftArm" else f"{-60 + swing:g} 0 0" for bone in order]
        rows.append(" ".join(["0 95 0", *turns]))
    motion = ["MOTION", f"Frames: {frames}", "Frame Time: 0.0333333", *rows]
    return "\n".join(["HIERARCHY", *hierarchy, *motion, ""]).encode()


NAMELESS = {bone: f"b{index}" for index, bone in enumerate(BONES)}
"""Names that say nothing."""
