"""Surfaces of triangles: who neighbours whom, normals and areas, what lies nearest, inside or outside; made even, finer, or whole again."""
