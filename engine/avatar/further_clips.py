"""Further clips of the same person, of arms or the back say: what they measured laid onto what the body's clip did."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from engine.avatar.stages import ClipScan
from engine.geometry.point_clouds.point_cloud import joined, thinned
from engine.geometry.registration.iterative_closest_point import rigid_onto_cloud

FURTHER_CLOUD_SPACING_METRES = 0.004
"""Metres between the points by which clouds are laid onto one another."""
CLOUD_GATES_METRES = (0.03, 0.015)
"""Metres within which points are taken to be of one surface: first, and once they are near."""
ICP_ITERATIONS = 8
"""Rounds of closest points with each of `CLOUD_GATES_METRES`."""


def onto_body(further: ClipScan, body: ClipScan) -> ClipScan:
    """A further clip's scan, turned and shifted by what the person has moved since the body's clip."""
    target = thinned(body.dense.cloud, FURTHER_CLOUD_SPACING_METRES)
    for gate in CLOUD_GATES_METRES:
        points = thinned(further.dense.cloud, FURTHER_CLOUD_SPACING_METRES).points
        further = further.moved(rigid_onto_cloud(points, target.points, target.normals, gate, ICP_ITERATIONS))
    return further


def with_further(body: ClipScan, further: Sequence[ClipScan]) -> ClipScan:
    """The body's scan with the clouds of further clips, which lie on it, in its own."""
    if not further:
        return body
    found = [body.dense, *(one.dense for one in further)]
    cloud, support = joined([one.cloud for one in found]), np.concatenate([one.support for one in found])
    return replace(body, dense=replace(body.dense, cloud=cloud, support=support))
