"""What a user may choose about a search for segments."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict


class MomentsOptions(BaseModel):
    """There is nothing to choose: a search finds what there is."""

    model_config = ConfigDict(extra="forbid", frozen=True)
