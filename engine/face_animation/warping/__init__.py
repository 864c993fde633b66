"""The picture in layers, and how each is warped."""
