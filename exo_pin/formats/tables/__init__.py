"""Numeric tables in text files: our own gaits and poses, and anybody's table of angles."""
