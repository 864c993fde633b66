"""A person taken apart: arms that pass before the trunk are surfaces of their own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from engine.character.figure.figure import Choice, find_figure
from engine.character.figure.silhouette import cut_out
from engine.character.fit.template_fit import load_human, pose_template
from engine.character.stages import fit_template, label
from engine.character.surface.front_and_back import Layer
from engine.character.surface.layers import build_layers
from engine.media.limits import Limits


def layers_of(photo: Path, joint: str) -> tuple[list[Layer], int, int]:
    """The layers of the person in a picture, and where one of the joints is on the grid: column and row."""
    figure = find_figure(photo, Choice(), False, Limits(), lambda code, message: None)
    silhouette = cut_out(figure, None, (), Limits(), None, None, lambda code, message: None)
    fitted, human = fit_template(figure, silhouette), load_human()
    labels = label(figure, silhouette, fitted, None, (), Limits(), lambda code, message: None)
    posed = pose_template(fitted, silhouette.camera(fitted.picture_camera()), human)
    x, y = np.rint(silhouette.to_grid[:, :2] @ figure.point(joint) + silhouette.to_grid[:, 2]).astype(int)
    return build_layers(labels, posed, human.rig), x, y


def test_behind_a_hand_before_the_trunk_the_trunk_goes_on(media: Callable[[str], Path]) -> None:
    """A man who holds a mug before his belly. Looked at: trunk without arms, and both arms whole."""
    (body, *arms), x, y = layers_of(media("fullbody/man_mug_arm_across.png"), "RightWrist")
    holding = [arm for arm in arms if arm.mask[y, x]]
    assert len(arms) == 2 and len(holding) == 1
    assert body.mask[y, x]
    assert holding[0].front.depth[y, x] > body.front.depth[y, x]


def test_arms_away_from_the_trunk_are_one_with_it(media: Callable[[str], Path]) -> None:
    layers, x, y = layers_of(media("fullbody/iper_apose_1.jpg"), "RightWrist")
    assert len(layers) == 1
    assert layers[0].mask[y, x]
