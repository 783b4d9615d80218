"""Untrusted XML, YAML and TOML files, read within limits of size and depth; one module each."""
