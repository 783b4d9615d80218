"""A walk on its ground: which foot stands, how the pelvis is supported, where everything is."""
