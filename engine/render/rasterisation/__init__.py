"""Triangles to pixels: what covers each, smooth outlines, and what is seen from where."""
