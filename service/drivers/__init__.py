"""The endpoints of driving videos: built-in performances, and the user's own."""
