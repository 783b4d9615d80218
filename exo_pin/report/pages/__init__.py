"""Whole pages: one walk, the paper's figures, a comparison of devices, a study; each assembles sections."""
