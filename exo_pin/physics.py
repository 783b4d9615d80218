"""Physical constants."""

GRAVITY = 9.81
"""Standard acceleration of free fall, rounded as the sources of this package do [m/s^2]."""
