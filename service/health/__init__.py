"""For machines that watch: whether the service lives, and its figures."""
