"""Recordings of Xsens MVN (.mvnx): joint angles, the pelvis's motion and foot contacts."""

from exo_pin.formats.xsens.mvnx_file import MvnxFile, open_mvnx

__all__ = ["MvnxFile", "open_mvnx"]
