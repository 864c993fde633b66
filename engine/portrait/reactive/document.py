"""`profile.json`: what a player must know of a profile. docs/reactive.md describes it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Count = Annotated[int, Field(ge=1)]
Pixels = Annotated[int, Field(ge=2)]


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class StatePart(_Part):
    """A state and its clip, which begins at rest. A clip that does not loop also ends there; one that does leads from
    its last frame into its first."""

    title: str
    emotion: str
    clip: str = Field(description="The clip's file, relative to this document.")
    frames: Count
    loops: bool


class TransitionPart(_Part):
    """How a state is left: at the end of its clip, and from the midst of it."""

    end: str = Field(description="The state that follows when the clip has ended.")
    bridges: str | None = Field(description="The file that holds the bridges to rest, one after another.")
    segments: list[tuple[Annotated[int, Field(ge=0)], Count]] = Field(
        description="For each bridge the first of its frames in that file, and how many lead to rest; the next frame is at rest."
    )
    at: list[Annotated[int, Field(ge=-1)]] = Field(
        description="For each frame of the clip the bridge that leads on from it; -1: none is needed, it is at rest."
    )


class TriggerPart(_Part):
    """What sets a state off."""

    on: Literal["hover", "click", "key", "view"]
    state: str
    key: str | None = Field(None, description="For `key` alone: as KeyboardEvent.key names it.")


class Profile(_Part):
    """A reactive profile, version 1 of the format."""

    version: Literal[1] = 1
    size: tuple[Pixels, Pixels] = Field(description="Width and height of all clips, pixels.")
    fps: Annotated[float, Field(gt=0)]
    poster: str = Field(description="The picture at rest: the first frame of every clip.")
    initial: str = Field(description="The state to begin with.")
    states: dict[str, StatePart]
    transitions: dict[str, TransitionPart] = Field(description="By the state that is left.")
    triggers: list[TriggerPart]

    def files(self) -> Sequence[str]:
        """All files that it names."""
        bridges = [one.bridges for one in self.transitions.values() if one.bridges is not None]
        return [self.poster, *(state.clip for state in self.states.values()), *bridges]


def schema() -> str:
    """The JSON Schema of `profile.json`, as web/reactive/profile.schema.json has it for those who read profiles."""
    described = {"$schema": "https://json-schema.org/draft/2020-12/schema", **Profile.model_json_schema()}
    return json.dumps(described, indent=2) + "\n"
