"""Faces, bodies, hands and person masks behind one small interface; one file per backend."""
