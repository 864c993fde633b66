"""How another person's motion moves this face (section 4, "Dynamic 3D Model")."""
