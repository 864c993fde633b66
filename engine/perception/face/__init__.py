"""Faces: meshes of landmarks, what these mean, the head's pose, and what covers the skin."""
