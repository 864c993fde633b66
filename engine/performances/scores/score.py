"""What the actor does in each performance, second by second.

Every performance starts and ends in the same neutral pose (closed mouth, open eyes, looking into the camera), so
that one can be played after another. Weights of the face units (ARKit's names) are written as blends: what a
muscle group does together. The shapes were checked against real drivers: lip corners and brows rise in 0.3 to
0.6 s and fall more slowly; one side leads; the eyes answer before the mouth does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from engine.performances.catalogue import scored
from engine.performances.modelling.figure import Pose
from engine.performances.scores import delight, distress, gestures, presence, speech

PERFORMANCE_SECONDS: Mapping[str, float] = {performance.name: performance.seconds for performance in scored()}

SCORES: Mapping[str, Callable[[float], Pose]] = {
    "idle": presence.idle,
    "idle-strong": presence.idle_strong,
    "happy": delight.happy,
    "happy-strong": delight.happy_strong,
    "surprise": delight.surprise,
    "surprise-strong": delight.surprise_strong,
    "anger": distress.anger,
    "anger-strong": distress.anger_strong,
    "fear": distress.fear,
    "fear-strong": distress.fear_strong,
    "sadness": distress.sadness,
    "sadness-strong": distress.sadness_strong,
    "nod": gestures.nod,
    "nod-strong": gestures.nod_strong,
    "shake": gestures.shake,
    "shake-strong": gestures.shake_strong,
    "wink": gestures.wink,
    "wink-strong": gestures.wink_strong,
    "talk": speech.talk,
    "talk-strong": speech.talk_strong,
}
