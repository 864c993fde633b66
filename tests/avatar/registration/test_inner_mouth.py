"""The mouth's inside goes with its rim."""

from __future__ import annotations

import numpy as np
from known_person import KnownPerson

from engine.avatar.registration.inner_mouth import inner_skin
from engine.avatar.registration.models import HumanModels


def test_what_is_not_seen_goes_with_what_is(models: HumanModels, person: KnownPerson) -> None:
    before = person.vertices[models.skin.vertices]
    inner = models.skin.regions["inner"]
    after = before + np.array([0.01, -0.02, 0.03])
    after[inner] += np.random.default_rng(0).normal(0, 0.02, (inner.sum(), 3))  # whatever the fit made of it
    found = inner_skin(models.skin, before, after)
    assert np.array_equal(found[~inner], after[~inner])
    off = np.linalg.norm(found[inner] - before[inner] - [0.01, -0.02, 0.03], axis=1)
    assert np.median(off) < 1e-6
