"""Built-in performances: short driving videos of an actor who belongs to the project.

The actor is made from the CC0 human template (`engine.body`) with a skin, eyes, teeth, hair and light of the
project's own, so that nobody's likeness is shipped. Reading order for how: `score` (what he does and when),
`figure` (his body in a pose), `actor` (skin, eyes, teeth, hair, shirt put together), `studio` (camera and light),
`filming` (frame after frame).
"""

from engine.performances.catalogue import (
    PERFORMANCE_STATES,
    Performance,
    State,
    catalogue,
    names,
    performance,
    poster,
    video,
)

__all__ = ["PERFORMANCE_STATES", "Performance", "State", "catalogue", "names", "performance", "poster", "video"]
