"""Faces and heads of the template: where landmarks lie on it, how heads differ, and what a face does."""
