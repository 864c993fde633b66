"""Points measured on a surface: cleaned, thinned, and asked where the surface is."""
