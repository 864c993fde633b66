"""Where set-up puts the file of dlib's network (`scripts/identity_model.py`)."""
