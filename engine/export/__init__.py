"""Results out: videos, and 3D files."""
