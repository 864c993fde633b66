"""Rasteriser, cameras and light: pictures of meshes without any graphics hardware."""
