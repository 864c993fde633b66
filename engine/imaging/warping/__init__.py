"""Pictures on triangles, and how these move."""
