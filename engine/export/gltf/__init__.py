"""Characters as glTF: GLB, its parts and its compression, and VRM, which is built on it."""
