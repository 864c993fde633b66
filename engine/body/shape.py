"""The space of human shapes: age, gender and build, and hundreds of local changes to a face or body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from itertools import product

import numpy as np
from numpy.typing import NDArray

from engine.body import makehuman
from engine.body.cache import cached_arrays
from engine.body.targets import Targets, compact, expand, gather
from engine.body.template import load_template

AGE_ANCHORS = {"baby": 0.0, "child": 0.1875, "young": 0.5, "old": 1.0}
"""Anchors of the age axis: about 1, 11, 25 and 90 years."""

PHENOTYPE_RACES = ("african", "asian", "caucasian")


@dataclass(frozen=True)
class Phenotype:
    """The large features of a person, each in [0, 1]; 0.5 is the average adult.

    age : see `AGE_ANCHORS`.
    gender : 0 female, 1 male.
    height, proportions : have no effect at 0.5.
    african, asian, caucasian : shares of MakeHuman's three head shapes, normalised to sum to one.
    """

    age: float = 0.5
    gender: float = 0.5
    muscle: float = 0.5
    weight: float = 0.5
    height: float = 0.5
    proportions: float = 0.5
    african: float = 1 / 3
    asian: float = 1 / 3
    caucasian: float = 1 / 3

    def __post_init__(self) -> None:
        for field in fields(self):
            if not 0 <= getattr(self, field.name) <= 1:
                raise ValueError(f"{field.name} must lie in [0, 1]")
        if self.african + self.asian + self.caucasian <= 0:
            raise ValueError("the shares of the head shapes must not all be zero")


@dataclass(frozen=True)
class ShapeSpace:
    """Targets for phenotypes and local changes over the template's `rest` vertices (V, 3) float32 metres."""

    rest: NDArray[np.float32]
    phenotypes: Targets
    changes: Targets
    rooms: Mapping[str, tuple[str, ...]]
    """The names of the local changes by the part of the body that they change: `nose`, `chin`, ..."""

    def shape(self, phenotype: Phenotype, changes: Mapping[str, float] | None = None) -> NDArray[np.float32]:
        """The template's vertices, (V, 3) float32 metres, for a phenotype and weighted local changes.

        Raises
        ------
        KeyError : there is no local change of that name.
        """
        moved = self.phenotypes.displacement(phenotype_weights(phenotype))
        return self.rest + moved + self.changes.displacement(changes or {})


def load_shape_space() -> ShapeSpace:
    """Load the shape space; the first time, convert it from the installed package (about half a minute)."""
    stored = cached_arrays("shape", _convert)
    rest = load_template().vertices
    targets = {}
    for kind in ("phenotypes", "changes"):
        own = {name.removeprefix(f"{kind}_"): array for name, array in stored.items() if name.startswith(f"{kind}_")}
        targets[kind] = expand(own, len(rest))
    rooms: dict[str, list[str]] = {}
    for name, room in zip(targets["changes"].names, stored["rooms"], strict=True):
        rooms.setdefault(str(room), []).append(name)
    return ShapeSpace(rest, targets["phenotypes"], targets["changes"], {k: tuple(v) for k, v in rooms.items()})


def phenotype_weights(phenotype: Phenotype) -> dict[str, float]:
    """The weight of each phenotype target: products of piecewise linear weights along the axes.

    Names are those of the files, such as `caucasian-female-young` or
    `universal-male-old-averagemuscle-minweight`.
    """
    ages = _between(phenotype.age, AGE_ANCHORS)
    genders = {"female": 1 - phenotype.gender, "male": phenotype.gender}
    muscles = _between(phenotype.muscle, {"minmuscle": 0.0, "averagemuscle": 0.5, "maxmuscle": 1.0})
    weights = _between(phenotype.weight, {"minweight": 0.0, "averageweight": 0.5, "maxweight": 1.0})
    heights = _between(phenotype.height, {"minheight": 0.0, "": 0.5, "maxheight": 1.0})
    proportions = _between(phenotype.proportions, {"uncommonproportions": 0.0, "": 0.5, "idealproportions": 1.0})
    total = phenotype.african + phenotype.asian + phenotype.caucasian
    races = {race: getattr(phenotype, race) / total for race in PHENOTYPE_RACES}
    found = _products(races, genders, ages)
    found |= {f"universal-{name}": weight for name, weight in _products(genders, ages, muscles, weights).items()}
    for axis in (heights, proportions):
        axis.pop("", None)
        found |= _products(genders, ages, muscles, weights, axis)
    return found


def _between(value: float, anchors: Mapping[str, float]) -> dict[str, float]:
    """Linear weights of the two anchors around `value`; zero weights are left out."""
    names, places = list(anchors), np.array(list(anchors.values()))
    weights = [np.interp(value, places, np.eye(len(places))[i]) for i in range(len(places))]
    return {name: float(weight) for name, weight in zip(names, weights, strict=True) if weight > 0}


def _products(*axes: Mapping[str, float]) -> dict[str, float]:
    joined = {}
    for choice in product(*(axis.items() for axis in axes)):
        weight = float(np.prod([share for _, share in choice]))
        if weight > 0:
            joined["-".join(name for name, _ in choice)] = weight
    return joined


def _convert() -> dict[str, np.ndarray]:
    found: dict[str, dict[str, tuple]] = {"phenotypes": {}, "changes": {}}
    rooms = []
    for room, name, path in makehuman.shape_target_files():
        kind = "phenotypes" if room.startswith("macrodetails") else "changes"
        found[kind][name] = makehuman.read_target(path)
        if kind == "changes":
            rooms.append(room)
    vertex_count = len(load_template().vertices)
    arrays: dict[str, np.ndarray] = {"rooms": np.array(rooms)}
    for kind, read in found.items():
        packed = compact(gather(read, vertex_count))
        arrays |= {f"{kind}_{part}": array for part, array in packed.items()}
    return arrays
