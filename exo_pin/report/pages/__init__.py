"""Whole pages: one walk, a comparison of devices, a study, the paper's figures."""
