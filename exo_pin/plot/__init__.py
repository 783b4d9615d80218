"""Plots of walks with matplotlib: joint angles with the normal band, torques, one joint against another."""

from exo_pin.plot.curves import joints, phase, torques

__all__ = ["joints", "phase", "torques"]
