"""Meshes with fewer triangles: edges are collapsed, the cheapest first."""
