"""Whole pictures: a character or a surface over a backdrop, and how the camera moves."""
