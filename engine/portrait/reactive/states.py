"""What a profile can do: its states, and what sets them off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from engine.errors import InputError
from engine.performances import Performance, catalogue, video
from engine.portrait.options import PortraitOptions

IDLE_STATE = "idle"
"""The performance that a profile is in when nothing sets off another."""
MAX_BY_DEFAULT = 5
"""States besides the idle one: a profile then has a few megabytes."""
OWN_STATE = "driver"
"""The state that a driving video of the user's own becomes."""


@dataclass(frozen=True)
class State:
    """One state: the `video` that drives it, and that video's neutral frame where it is known.

    `loops`: it is played again and again until something happens. `own`: the video is the user's.
    """

    name: str
    title: str
    emotion: str
    video: Path
    neutral_frame: int | None = None
    loops: bool = False
    own: bool = False


def choose_states(options: PortraitOptions, driver: Path | None) -> tuple[State, ...]:
    """The states of a profile, the idle one first.

    Raises `InputError` `performance_not_installed`.
    """
    there = {one.name: one for one in catalogue() if _installed(one.name)}
    requested = options.reactive if isinstance(options.reactive, tuple) else default_states(tuple(there.values()))
    names = tuple(dict.fromkeys((IDLE_STATE, *requested)))
    if missing := [name for name in names if name not in there]:
        offered = ", ".join(there)
        raise InputError(
            "performance_not_installed", f"The performance {missing[0]} has no video here: choose of {offered}."
        )
    states = [_built_in(there[name]) for name in names]
    if driver is not None and driver not in [state.video for state in states]:
        known = next((one for one in there.values() if video(one.name) == driver), None)
        own = State(OWN_STATE, "Your own performance", "own", driver, options.neutral_frame, own=True)
        states.append(own if known is None else _built_in(known))
    return tuple(states)


def default_states(there: Sequence[Performance]) -> tuple[str, ...]:
    """The first performance of each state but the idle one, in the order of the catalogue, `MAX_BY_DEFAULT` at most."""
    first: dict[str, str] = {}
    for one in there:
        first.setdefault(one.state, one.name)
    return tuple(name for name in first.values() if name != IDLE_STATE)[:MAX_BY_DEFAULT]


def default_triggers(states: Sequence[State]) -> list[dict[str, str]]:
    """A smile for who comes near, a start for who pokes, and each state on a key of its own, 1 to 9."""
    others = [state for state in states if state.name != IDLE_STATE]
    if not others:
        return []
    happy = next((state for state in others if state.emotion == "happiness"), others[0])
    start = next((state for state in others if state.emotion == "surprise"), others[-1])
    keys = [{"on": "key", "key": str(place), "state": one.name} for place, one in enumerate(others[:9], 1)]
    return [{"on": "hover", "state": happy.name}, {"on": "click", "state": start.name}, *keys]


def _built_in(one: Performance) -> State:
    loops = one.name == IDLE_STATE
    return State(one.name, one.title, one.emotion, video(one.name), one.neutral_frame, loops)


def _installed(name: str) -> bool:
    try:
        return video(name).is_file()
    except FileNotFoundError:
        return False
