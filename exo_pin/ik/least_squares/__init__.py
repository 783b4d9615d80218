"""Damped least squares: one driver, and the kernels for a leg, a subtree, a sample and a trajectory."""
