"""From the joints of any motion to those of the character."""
