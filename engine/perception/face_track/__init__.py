"""One face followed through a video (`track`): its mesh, its surroundings, and how it looks, frame by frame."""
