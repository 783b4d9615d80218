"""`python -m exo_pin` is `exo-pin`."""

from exo_pin.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
