"""A surface laid flat, and its pieces packed into a texture."""
