"""Untrusted XML, YAML, TOML and numbers in texts, read within limits of size and depth; one module each."""
