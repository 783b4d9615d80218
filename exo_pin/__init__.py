"""exo_pin."""
