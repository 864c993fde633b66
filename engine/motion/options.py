"""What a user may choose about a motion, whatever is moved by it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

JointName = Annotated[str, Field(max_length=40)]
MotionJoints = Annotated[
    dict[JointName, Annotated[str, Field(max_length=200)] | None],
    Field(
        max_length=100,
        description='The joints of the motion\'s file that move the character\'s where they are not found by themselves: {"Hips": "pelvis"}. null leaves one out.',
    ),
]
MotionClip = Annotated[
    str | None,
    Field(
        max_length=200,
        description="Which of a GLB's animations is played, by its name; by default the first in which something moves.",
    ),
]
