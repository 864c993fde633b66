"""A shell bound to its skeleton."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.rig.measures import picture_camera, pose
from engine.character.rig.shell_binding import bind_shell
from engine.character.shell.at_rest import shell_at_rest
from engine.character.shell.piece import Colours, Piece
from engine.character.shell.shell import Shell
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.mesh.welding import is_closed, weld
from tests.character.fit.test_head_and_legs import figure_with
from tests.character.shell.test_displacement import arms_down


@pytest.fixture(scope="module")
def made() -> tuple[FittedBody, Silhouette, Shell]:
    """A template that is displaced by three pixels towards the viewer, in a green picture."""
    fitted, mesh = arms_down(), template_mesh()
    camera = fitted.picture_camera()
    posed = pose_template(fitted, camera, load_human())
    template, straight = posed.vertices[mesh.ids], posed.rest[mesh.ids]
    pictured = template + np.array([0, 0, 3])
    rest = shell_at_rest(mesh, straight, template, pictured, camera, fitted)
    mask = np.zeros((800, 600), np.bool_)
    mask[100:700, 50:550] = True
    soft, rgb = mask.astype(np.float32), np.full((800, 600, 3), [0, 200, 0], np.uint8)
    return fitted, Silhouette(soft, soft, mask, rgb, np.eye(2, 3)), Shell(mesh, template, pictured, rest)


def test_as_pictured_it_lies_where_the_picture_has_it(made: tuple[FittedBody, Silhouette, Shell]) -> None:
    fitted, silhouette, shell = made
    character = bind_shell(shell, figure_with(None), silhouette, fitted, np.zeros((8, 8, 3), np.uint8))
    seen = picture_camera(character, fitted, (800, 600)).project(pose(character, character.pictured))
    off = np.linalg.norm(seen[:, :2] - shell.pictured[shell.mesh.corners, :2], axis=1)
    assert np.percentile(off, 99) < 1  # pixels of 800
    bound = character.mesh
    assert is_closed(weld(bound)[bound.triangles]) and abs(bound.vertices[:, 1].min()) < 1e-5
    np.testing.assert_allclose(bound.weights.sum(1), 1, atol=1e-6)


def test_a_piece_comes_with_the_colours_of_the_picture(made: tuple[FittedBody, Silhouette, Shell]) -> None:
    fitted, silhouette, shell = made
    corners = np.array([[300, 400, 0], [320, 400, 0], [300, 420, 0], [300, 400, 20]], np.float64)
    faces = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], np.int32)
    hips = np.zeros((4, 4), np.intp)
    piece = Piece("Hips", corners, faces, hips, np.tile(np.array([1, 0, 0, 0], np.float32), (4, 1)))
    figure = replace(figure_with(None), rgb=silhouette.rgb)
    chart = np.full((64, 64, 3), [250, 0, 0], np.uint8)
    character = bind_shell(replace(shell, pieces=(piece,)), figure, silhouette, fitted, chart)
    mesh = character.mesh
    size = np.array(mesh.texture.shape[1::-1])
    x, y = np.clip(np.rint(mesh.uv * size - 0.5).astype(int), 0, size - 1).T
    colours = mesh.texture[y, x]
    assert (colours[-4:] == [0, 200, 0]).all() and (colours[:-4] == [250, 0, 0]).mean() > 0.99
    seen = picture_camera(character, fitted, (800, 600)).project(pose(character, character.pictured))
    np.testing.assert_allclose(seen[-4:, :2], corners[:, :2], atol=0.05)


def test_a_piece_with_colours_of_its_own_has_those(made: tuple[FittedBody, Silhouette, Shell]) -> None:
    """Its upper half is blue and its lower one white, whatever the picture has there, and a piece beside it has the picture's."""
    fitted, silhouette, shell = made
    corners = np.array([[300, 400, 0], [320, 400, 0], [300, 420, 0], [320, 420, 20]], np.float64)
    faces = np.array([[0, 1, 2], [1, 3, 2], [0, 2, 1], [1, 2, 3]], np.int32)
    weights = np.tile(np.array([1, 0, 0, 0], np.float32), (4, 1))
    own = np.concatenate([np.full((16, 24, 3), [0, 0, 250], np.uint8), np.full((16, 24, 3), 255, np.uint8)])
    colours = Colours(np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]]), own)
    pieces = tuple(Piece("Head", corners, faces, np.zeros((4, 4), np.intp), weights, one) for one in (None, colours))
    figure = replace(figure_with(None), rgb=silhouette.rgb)
    chart = np.full((64, 64, 3), [250, 0, 0], np.uint8)
    mesh = bind_shell(replace(shell, pieces=pieces), figure, silhouette, fitted, chart).mesh
    size = np.array(mesh.texture.shape[1::-1])
    x, y = np.clip(np.rint(mesh.uv * size - 0.5).astype(int), 0, size - 1).T
    found = mesh.texture[y, x]
    assert (found[-8:-4] == [0, 200, 0]).all(), "the picture's"
    assert (found[-4:-2] == [0, 0, 250]).all() and (found[-2:] == 255).all()
