"""A shell bound to its skeleton."""

from __future__ import annotations

import numpy as np

from engine.character.fit.template_fit import load_human, pose_template
from engine.character.rig.measures import picture_camera, pose
from engine.character.rig.shell_binding import bind_shell
from engine.character.shell.at_rest import shell_at_rest
from engine.character.shell.shell import Shell
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.welding import is_closed, weld
from tests.character.shell.test_displacement import arms_down


def test_as_pictured_it_lies_where_the_picture_has_it() -> None:
    fitted, mesh = arms_down(), template_mesh()
    camera = fitted.picture_camera()
    posed = pose_template(fitted, camera, load_human())
    template, straight = posed.vertices[mesh.ids], posed.rest[mesh.ids]
    pictured = template + np.array([0, 0, 3])
    rest = shell_at_rest(mesh, straight, template, pictured, camera, fitted)
    shell = Shell(mesh, template, pictured, rest)
    character = bind_shell(shell, camera, fitted, np.zeros((8, 8, 3), np.uint8))
    seen = picture_camera(character, fitted, camera.camera.size).project(pose(character, character.pictured))
    off = np.linalg.norm(seen[:, :2] - pictured[mesh.corners, :2], axis=1)
    assert np.percentile(off, 99) < 1  # pixels of 800
    bound = character.mesh
    assert is_closed(weld(bound)[bound.triangles]) and abs(bound.vertices[:, 1].min()) < 1e-5
    np.testing.assert_allclose(bound.weights.sum(1), 1, atol=1e-6)
