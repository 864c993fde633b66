"""The endpoints of motions: the built-in ones, and the user's own."""
