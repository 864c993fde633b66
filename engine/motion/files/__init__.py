"""Motions as they come: BVH and glTF files."""
