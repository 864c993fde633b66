"""Textures of surfaces: looked up at every size, and baked from pictures."""
