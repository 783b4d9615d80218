"""OpenSim files: coordinates, inverse dynamics and ground reaction forces (.mot, .sto), models (.osim)."""

from exo_pin.formats.opensim.motion_writer import write_gait
from exo_pin.formats.opensim.storage_file import StorageFile, open_storage

__all__ = ["StorageFile", "open_storage", "write_gait"]
