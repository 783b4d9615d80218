"""Files from strangers: XML, YAML and TOML, read within limits of size and depth."""
