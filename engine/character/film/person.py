"""One who is woken."""

from __future__ import annotations

from dataclasses import dataclass

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.film.film import moving_camera
from engine.character.film.motions import MotionChoice, choose_motion, posed_by_hand
from engine.character.fit.template_fit import FittedBody
from engine.character.options import CharacterOptions
from engine.character.parts.label_map import Labels
from engine.character.rig.measures import picture_camera
from engine.character.rig.rigging import Character
from engine.motion.files.source_motion import SourceMotion


@dataclass
class Person:
    """One who is woken, with all that was found on the way. `act` says what they do."""

    figure: Figure
    silhouette: Silhouette
    fitted: FittedBody
    labels: Labels
    character: Character

    def act(self, options: CharacterOptions, motion: SourceMotion | None, main: Character) -> None:
        """Choose the pose they `start` from and what is `played`, before a camera that moves about the `main` character."""
        height, width = self.figure.rgb.shape[:2]
        camera = picture_camera(self.character, self.fitted, (height, width))
        self.start = posed_by_hand(self.character, options.pose)
        self.played = choose_motion(
            self.character,
            moving_camera(main, camera, options.camera, of=self.character),
            self.start,
            MotionChoice(
                *(options.motion, motion, options.keep, options.seconds, options.fps), joints=options.motion_joints
            ),
        )
