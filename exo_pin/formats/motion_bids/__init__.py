"""Motion-BIDS: a walk or markers in `*_motion.tsv`, with the channels, metadata and events beside it."""

from exo_pin.formats.motion_bids.bids_writer import write_motion_bids
from exo_pin.formats.motion_bids.file_names import is_motion_bids
from exo_pin.formats.motion_bids.motion_file import MotionBidsFile, open_motion_bids

__all__ = ["MotionBidsFile", "is_motion_bids", "open_motion_bids", "write_motion_bids"]
