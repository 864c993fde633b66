"""3D algorithms: meshes that bones move, warps in mean value coordinates, depth from normals, labels by graph cuts."""
