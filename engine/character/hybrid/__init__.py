"""Characters of two surfaces: the relief of trunk, head and cloth, and the shell's arms and legs, which reach into it."""
