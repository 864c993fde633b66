"""What every performance does alike: eyes that hold their aim, lids that follow them, weights that add up."""

from __future__ import annotations

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.performances.modelling.figure import Pose
from engine.performances.scores.timing import ease, idle_noise

Units = dict[str, float]


def pose(
    units: Units,
    head: tuple[float, float, float],
    gaze: tuple[float, float],
    breath: float,
    lean: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Pose:
    """Let the lids follow the gaze, as they do, and the eyes hold their aim while the head turns."""
    up, left = gaze[0] + 0.9 * head[0], gaze[1] - 0.9 * head[1]
    for side in SIDE_NAMES:
        add(units, f"eyeLookUp{side}", max(up, 0.0) / 30)
        add(units, f"eyeLookDown{side}", max(-up, 0.0) / 30)
    return Pose(units=units, head=head, lean=lean, gaze=(up, left), breath=breath)


def lids(units: Units, shut: float, lead: float, squint: float = 0.0) -> None:
    """Close both eyes; the left is ahead by a small share of the way, the lower lid comes up to meet the upper."""
    for side, share in (("Left", 1 + lead), ("Right", 1 - lead)):
        closed = min(max(shut * (1 if shut > 0.9 else share), 0.0), 1.0)
        add(units, f"eyeBlink{side}", closed)
        add(units, f"eyeSquint{side}", 0.12 * closed * (1 - squint))
        add(units, f"browDown{side}", 0.035 * closed)


def add(units: Units, name: str, weight: float) -> None:
    units[name] = units.get(name, 0.0) + weight


def add_both_sides(units: Units, name: str, weight: float, right: float = 0.94) -> None:
    """Add a unit on both sides; the right one is a little weaker, as no face is quite even."""
    add(units, f"{name}Left", weight)
    add(units, f"{name}Right", right * weight)


def head_sway(t: float, seed: int, seconds: float, degrees: float) -> tuple[float, float, float]:
    """What a head does that is held still, (pitch, yaw, roll); zero at both ends of a performance."""
    calm = degrees * ease(t, 0.0, 0.3) * (1 - ease(t, seconds - 0.4, seconds - 0.05))
    return (
        calm * idle_noise(t, seed, seconds, 4),
        calm * idle_noise(t, seed + 1, seconds, 4),
        0.6 * calm * idle_noise(t, seed + 2, seconds, 3),
    )


def sum_turns(*parts: tuple[float, float, float]) -> tuple[float, float, float]:
    """Turns of the head added up."""
    pitch, yaw, roll = (sum(turn) for turn in zip(*parts, strict=True))
    return pitch, yaw, roll
