"""The commands of `exo-pin`, one module each."""
