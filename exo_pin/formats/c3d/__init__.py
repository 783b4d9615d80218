"""C3D trials: markers, model angles, events and force plates."""

from exo_pin.formats.c3d.c3d_file import C3dFile, open_c3d
from exo_pin.formats.c3d.writer import write_gait

__all__ = ["C3dFile", "open_c3d", "write_gait"]
