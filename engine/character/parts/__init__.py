"""Which part of the body each pixel shows, and which limb passes before which (the paper's section 4.2.1)."""
