"""Triangle meshes: read from files, found for a URDF, thinned, or made from simple shapes."""
