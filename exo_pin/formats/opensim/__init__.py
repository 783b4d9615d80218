"""OpenSim files: coordinates (.mot, .sto), models (.osim), ground reaction forces."""
