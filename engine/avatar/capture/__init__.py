"""From films to clouds: frames, cameras, dense stereo (the paper's sections 3.1 and 3.2)."""
