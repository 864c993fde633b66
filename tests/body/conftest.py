"""The template, converted once for all tests of this folder."""

import pytest

from engine.body import ShapeSpace, Template, load_shape_space, load_template


@pytest.fixture(scope="session")
def template() -> Template:
    return load_template()


@pytest.fixture(scope="session")
def shape_space() -> ShapeSpace:
    return load_shape_space()
