"""How far from the viewer a face's points are, by how far they move from photograph to photograph as the head turns.

The tracker's own depths are nearly the same for everybody, and its points in turned faces keep to them. So they are led first to where the
photographs show the common face's pixels, by the flow that lays photographs on one another. Of the person's points under scaled
orthographic cameras all these places are then the least squares.

Source: C. Tomasi, T. Kanade, Shape and motion from image streams under orthography: a factorization method, IJCV 1992. Here cameras and
shape are found in turns, since each photograph shows other points, and the tracked face is a prior, since few photographs are turned far.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarity
from engine.geometry.registration.scaled_orthographic import scaled_orthographic
from engine.perception.face.landmarks import LEFT_EYE, LEFT_IRIS, MESH_SIZE, RIGHT_EYE, RIGHT_IRIS
from engine.persona.texture.texture_frame import TextureFrame

PRIOR_SIGMAS = 1.5
"""By how much the tracked face's points may be off, in what their places in one photograph are. Between 1 and 2 heads of known shape come
out alike."""
PLACE_SIGMA_EYE_DISTANCES = 0.04
"""Eye distances: places that are farther off are another expression's, or wrong, and count less."""
PARALLAX_ROUNDS = 6
FIRST_IRIS_VERTEX = min(RIGHT_IRIS + LEFT_IRIS)
"""Of the mesh. Irises, which are its last vertices, look where they like: they go with their lids."""


def depth_by_parallax(
    frame: TextureFrame,
    meshes: NDArray[np.floating],
    offsets: NDArray[np.floating],
    belief: NDArray[np.floating],
) -> NDArray[np.float64]:
    """(478,) eye distances by which the points of the frame's face are farther from the viewer than its mesh has them.

    meshes : (N, 478, 3) of the photographs, pixels.
    offsets : (N, H, W, 2) where in each photograph, as the frame has it, the common face's pixels are.
    belief : (N, H, W) in [0, 1].
    """
    face = frame.places[:MESH_SIZE] / frame.scale
    at = frame.places[:MESH_SIZE, :2].astype(np.float32)
    places = np.array([_places(frame, mesh, _at(offset, at)) for mesh, offset in zip(meshes, offsets, strict=True)])
    trust = np.array(
        [
            _at(believed * frame.facing(frame.rotation_of(mesh)), at)
            for mesh, believed in zip(meshes, belief, strict=True)
        ]
    )
    deeper = (
        face_by_parallax(face[:FIRST_IRIS_VERTEX], places[:, :FIRST_IRIS_VERTEX], trust[:, :FIRST_IRIS_VERTEX])
        - face[:FIRST_IRIS_VERTEX]
    )[:, 2]
    found = np.zeros(MESH_SIZE)
    found[:FIRST_IRIS_VERTEX] = deeper
    for eye, iris in ((RIGHT_EYE, RIGHT_IRIS), (LEFT_EYE, LEFT_IRIS)):
        found[list(iris)] = deeper[list(eye)].mean()
    return found


def face_by_parallax(
    face: NDArray[np.floating], places: NDArray[np.floating], trust: NDArray[np.floating]
) -> NDArray[np.float64]:
    """(V, 3) the points that photographs show at `places` (N, V, 2), each as far as its `trust` (N, V) goes; those of `face` (V, 3), in
    eye distances, where they do not tell. It lies on that face as it did."""
    prior = np.eye(3) / PRIOR_SIGMAS**2
    found = np.asarray(face, np.float64)
    for _ in range(PARALLAX_ROUNDS):
        cameras, shifts = scaled_orthographic(found, places)
        pixels = np.linalg.norm(cameras[:, 0], axis=-1)[:, None, None]
        cameras, seen = cameras / pixels, (places - shifts[:, None]) / pixels
        off = seen - np.einsum("nij,vj->nvi", cameras, found)
        counted = trust / (1 + (off**2).sum(axis=-1) / PLACE_SIGMA_EYE_DISTANCES**2)
        normal = np.einsum("nv,nij,nik->vjk", counted, cameras, cameras, optimize=True) + prior
        wanted = np.einsum("nv,nij,nvi->vj", counted, cameras, seen, optimize=True) + face @ prior
        found = np.linalg.solve(normal, wanted[..., None])[..., 0]
        found = fit_similarity(found, face)(found)
    return found


def _places(frame: TextureFrame, mesh: NDArray[np.floating], offset: NDArray[np.float32]) -> NDArray[np.float64]:
    """(478, 2) pixels of a photograph, where its `mesh` is led by the `offset` (478, 2) of each vertex, pixels of the frame."""
    lookup, at = frame.lookup(mesh), frame.places[:MESH_SIZE, :2].astype(np.float32)
    return np.asarray(mesh[:, :2] + _at(lookup, at + offset) - _at(lookup, at), np.float64)


def _at(layer: NDArray[np.floating], places: NDArray[np.float32]) -> NDArray[np.float32]:
    """(V, ...) what a layer (H, W, ...) has at `places` (V, 2)."""
    found = cv2.remap(
        layer.astype(np.float32), places[:, :1], places[:, 1:], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    return np.asarray(found, np.float32)[:, 0]
