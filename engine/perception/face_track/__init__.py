"""One face followed through a video: its mesh, its surroundings, and how it looks, frame by frame."""
