"""The live viewer: a web server on this machine, its messages, and feet dragged by hand."""
