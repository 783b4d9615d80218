"""Pictures and films, made by a headless browser."""
