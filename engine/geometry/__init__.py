"""3D algorithms: cameras, surfaces and meshes that bones move, rigid fits, warps in mean value coordinates, depth from normals,
labels by graph cuts."""
