"""How a target follows its driver: what of it, and how strongly."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Part = Literal["eyes", "mouth", "brows", "head"]
ACTING_PARTS: tuple[Part, ...] = ("eyes", "mouth", "brows", "head")


@dataclass(frozen=True)
class ActingOptions:
    """strength : how strongly the motion is carried over; 1 is as the driver does it.
    follow : the parts that follow the driver.
    head_3d : whether the head is turned by a 3D proxy, instead of by the paper's warp in the plane.
    """

    strength: float = 1.0
    follow: tuple[Part, ...] = ACTING_PARTS
    head_3d: bool = True
