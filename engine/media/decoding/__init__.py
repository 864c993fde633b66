"""Frames out of video files: opened safely, decoded, timed, and turned as they are to be shown."""
