"""Cameras and points from pictures of a scene that stands still, one picture after the other.

Source: J. L. Schoenberger, J.-M. Frahm, Structure-from-Motion Revisited, CVPR 2016; N. Snavely, S. Seitz, R. Szeliski,
Photo Tourism, SIGGRAPH 2006. `mapping` is where it is read from.
"""
