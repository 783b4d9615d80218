"""From a robot and a gait to the scene that the page shows."""
