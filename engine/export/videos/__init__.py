"""Videos out: formats and their encoders, frame by frame, with the sound of a driver."""
