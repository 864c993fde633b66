"""Light on surfaces: lamps, skin and hair, shadows on the ground, and from radiance to a picture."""
