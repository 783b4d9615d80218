"""C3D trials: markers, model angles, events and force plates."""
