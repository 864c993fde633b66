"""What a persona is beside its film: a model with face units, the textures of expressions, and pictures of them."""
