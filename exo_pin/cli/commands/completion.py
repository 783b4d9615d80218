"""`exo-pin completion`: a script by which a shell completes commands, options and names."""

from __future__ import annotations

import argparse

from exo_pin.cli import COMMANDS, command_parser
from exo_pin.cli.completion_script import SHELLS, completed, script

_EXAMPLES = """examples:
  source <(exo-pin completion bash)                                      this shell; put it into ~/.bashrc
  source <(exo-pin completion zsh)                                       put it into ~/.zshrc
  exo-pin completion fish > ~/.config/fish/completions/exo-pin.fish

Commands, options, and the names of devices, controllers, patients, robots and normal walks are completed."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("shell", choices=SHELLS, metavar="SHELL", help=f"one of {', '.join(SHELLS)}")


def run(args: argparse.Namespace) -> int:
    """Print the script."""
    from exo_pin.control import CONTROLLERS, PATIENTS
    from exo_pin.devices import DEVICES
    from exo_pin.gait import SPEEDS
    from exo_pin.retarget import TARGETS

    names = {
        "--device": tuple(DEVICES),
        "--controller": tuple(CONTROLLERS),
        "--patient": tuple(PATIENTS),
        "--robot": tuple(TARGETS),
        "GAIT": SPEEDS,
        "DEVICE": tuple(DEVICES),
    }
    print(script(args.shell, completed(command_parser(tuple(COMMANDS)), names)), end="")
    return 0
