"""OpenSim files: coordinates, inverse dynamics and ground reaction forces (.mot, .sto), models (.osim)."""

from exo_pin.formats.opensim.coordinate_csv import is_coordinate_csv, open_coordinate_csv
from exo_pin.formats.opensim.external_loads import write_external_loads, write_foot_forces, write_tool_setup
from exo_pin.formats.opensim.inverse_dynamics import write_torques
from exo_pin.formats.opensim.motion_writer import write_gait
from exo_pin.formats.opensim.storage_file import StorageFile, open_storage

__all__ = [
    "StorageFile",
    "is_coordinate_csv",
    "open_coordinate_csv",
    "open_storage",
    "write_external_loads",
    "write_foot_forces",
    "write_gait",
    "write_tool_setup",
    "write_torques",
]
