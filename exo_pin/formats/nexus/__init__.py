"""Exports of Vicon Nexus as text (.csv, .txt): sections of model outputs, markers, devices and events."""

from exo_pin.formats.nexus.nexus_file import NexusFile, is_nexus, open_nexus

__all__ = ["NexusFile", "is_nexus", "open_nexus"]
