"""The driver's fine details: ratios of light that become creases of the target."""
