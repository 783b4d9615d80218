"""Tables of text: joint angles, joint torques and foot poses over time."""

from exo_pin.formats.tables.pose_table import Poses, load_poses, save_poses
from exo_pin.formats.tables.table_file import (
    TABLE_SUFFIXES,
    TableFile,
    open_csv,
    open_tsv,
    write_csv_gait,
    write_tsv_gait,
)
from exo_pin.formats.tables.torque_table import write_csv_torques

__all__ = [
    "TABLE_SUFFIXES",
    "Poses",
    "TableFile",
    "load_poses",
    "open_csv",
    "open_tsv",
    "save_poses",
    "write_csv_gait",
    "write_csv_torques",
    "write_tsv_gait",
]
