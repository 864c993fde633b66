"""The fitted template, displaced to the person's outline, as a character's surface: nothing of it is cut, so nothing tears."""
