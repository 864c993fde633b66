"""What the character does, and the film of it: motions, the frame they stay in, shadows, what was found to be looked at."""
