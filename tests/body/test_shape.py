"""The shape space: weights that sum to one, and people who look like their numbers."""

import numpy as np
import pytest

from engine.body import Phenotype, ShapeSpace, Template
from engine.body.shape import phenotype_weights


@pytest.mark.parametrize("phenotype", [Phenotype(), Phenotype(age=0.3, gender=0.2, muscle=0.9, weight=0.1, african=1)])
def test_weights_of_each_family_sum_to_one(phenotype: Phenotype) -> None:
    weights = phenotype_weights(phenotype)
    universal = sum(w for name, w in weights.items() if name.startswith("universal"))
    races = sum(w for name, w in weights.items() if name.split("-")[0] in ("african", "asian", "caucasian"))
    assert universal == pytest.approx(1)
    assert races == pytest.approx(1)


def test_average_height_and_proportions_add_nothing() -> None:
    assert not any("height" in name or "proportions" in name for name in phenotype_weights(Phenotype()))


@pytest.mark.parametrize("seed", range(4))
def test_every_weighted_target_exists(shape_space: ShapeSpace, seed: int) -> None:
    values = np.random.default_rng(seed).uniform(0, 1, 9)
    assert set(phenotype_weights(Phenotype(*values))) - set(shape_space.phenotypes.names) <= {
        # nobody drew babies of other proportions
        name
        for name in phenotype_weights(Phenotype(*values))
        if "baby" in name and name.endswith("proportions")
    }


def test_stature_follows_age_gender_and_height(shape_space: ShapeSpace, template: Template) -> None:
    body = template.vertices_of("body")

    def stature(**phenotype: float) -> float:
        return float(np.ptp(shape_space.shape(Phenotype(**phenotype))[body, 1]))

    assert stature(age=0) < stature(age=0.1875) < stature(age=0.5)
    assert stature(gender=0) < stature(gender=1)
    assert stature(height=0) < stature(height=0.5) < stature(height=1)
    assert 1.5 < stature() < 1.9


def test_local_changes_stay_local(shape_space: ShapeSpace, template: Template) -> None:
    changed = shape_space.changes.displacement({"nose-hump-incr": 1})
    moved = np.linalg.norm(changed, axis=1) > 0
    assert 0 < moved.sum() < 500
    eyes = template.vertices[template.vertices_of("left_eye"), 1].mean()
    assert np.abs(template.vertices[moved, 1] - eyes).max() < 0.1
    assert "nose-hump-incr" in shape_space.rooms["nose"]


def test_phenotypes_outside_their_range_are_refused() -> None:
    with pytest.raises(ValueError, match="age"):
        Phenotype(age=1.2)
    with pytest.raises(ValueError, match="head shapes"):
        Phenotype(african=0, asian=0, caucasian=0)
