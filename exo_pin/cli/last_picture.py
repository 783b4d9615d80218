"""The last picture of `replay` for the same command line: served again at once, before NumPy is loaded.

It is replaced by this run's own picture, unless that is the same.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin import cache

if TYPE_CHECKING:
    from exo_pin.viewer import Server

_KIND = "scene"
_CODE = {".py", ".xacro", ".js", ".css", ".html"}
"""Files of the package that an older picture may not fit."""


def serve(words: Sequence[str]) -> Server | None:
    """A server that shows last time's picture, or None where nothing was kept for these words.

    Args:
        words: The command line behind `exo-pin`.
    """
    packed = recall(words)
    if packed is None:
        return None
    args, _ = _address().parse_known_args(words)  # cannot fail: these words were parsed before
    server = open_server(args)
    server.preview(packed)
    return server


def open_server(args: argparse.Namespace) -> Server:
    """A server by the arguments of `add_address`; its address is printed as soon as its port is open."""
    from exo_pin import viewer

    opens = not args.no_open and has_display()
    token = "" if args.no_token else None
    server = viewer.serve(host=args.host, port=args.port, token=token, open_browser=opens)
    _print_address(args, server)
    return server


def _print_address(args: argparse.Namespace, server: Server) -> None:
    """Print where the page is, and warnings about port and host."""
    if args.port and server.port != args.port:
        print(f"port {args.port} is in use: {server.port} is used instead", file=sys.stderr)
    if not server.loopback:
        kept = "nobody is kept out" if args.no_token else "the token in the address alone keeps others out"
        print(f"warning: {args.host} lets other machines connect, unencrypted; {kept}", file=sys.stderr)
    elif args.no_token:
        print("warning: without a token every user of this machine can watch", file=sys.stderr)
    print(f"{server.url}   Ctrl-C ends it", flush=True)
    if not has_display():
        print("no display here: open that address, or write a file with --html walk.html", flush=True)


def add_address(parser: argparse.ArgumentParser) -> None:
    """Port and host of the page, and whether a browser opens."""
    parser.add_argument(
        "--port", type=int, default=7000, help="port of the page, or the next free one (default: 7000)"
    )
    parser.add_argument(
        "--host", default="127.0.0.1", help="address to listen on (default: this machine only)"
    )
    parser.add_argument(
        "--no-token",
        action="store_true",
        help="an address without a token: everybody who reaches the port can watch",
    )
    parser.add_argument("--no-open", action="store_true", help="print the address, open no browser")


def has_display() -> bool:
    """Whether this machine can show a browser."""
    return sys.platform == "darwin" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))


def recall(words: Sequence[str]) -> bytes | None:
    """The packed scene that was kept for these words, files and code, or None."""
    return cache.recall(_KIND, _name(words))


def keep(words: Sequence[str], packed: bytes) -> None:
    """Keep a packed scene for the next run with these words."""
    cache.keep(_KIND, _name(words), packed)


def _address() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(add_help=False)
    add_address(parser)
    return parser


def _name(words: Sequence[str]) -> str:
    files = (part for word in words for part in (word, word.partition("=")[2]) if part)
    code = (path for path in sorted(Path(cache.__file__).parents[1].rglob("*")) if path.suffix in _CODE)
    return cache.key((os.getcwd(), *words, *_states(files), *_states(map(str, code))))


def _states(paths: Iterable[str]) -> Iterator[str]:
    """Size and time of each path that is there: another state gives another name."""
    for path in paths:
        try:
            state = os.stat(path)
        except (OSError, ValueError):
            continue
        yield f"{path} {state.st_size} {state.st_mtime_ns}"
