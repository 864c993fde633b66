"""The studio: light, what is seen in it, and frames from key frames."""
