"""Geometry of several views: cameras and points from what matches, dense depth, and the body within silhouettes."""
