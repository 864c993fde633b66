"""How the driver's face and head move, carried to the target."""
