"""The browser's process: found, started on pipes in a private folder, and ended whatever happens.

It opens no port that other users of this machine could reach. A shell guards it: when this process ends, even
if it is killed, the browser is killed and its folder removed.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Mapping, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import IO

from exo_pin import scratch
from exo_pin.errors import ExoPinError

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
"""Commands under which the browser is known; `EXO_PIN_CHROMIUM` names another."""

_FLAGS = (
    "--headless=new",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
    "--no-proxy-server",  # its pages are on this machine
    "--remote-debugging-pipe",
)

_GUARD = """
exec 3<&0 4>&1 5<&2 </dev/null >/dev/null 2>&1
folder=$1 short=$2; shift 2
"$@" 5<&- & browser=$!
exec 3<&- 4>&-
read -r end <&5
kill -KILL $browser; wait $browser
for attempt in 1 2 3 4 5; do rm -rf "$folder" "$short" && break; sleep 0.1; done
kill -KILL 0
"""
"""The shell's script. The browser reads commands from descriptor 3 and writes answers to 4.

Descriptor 5 ends when this process does, however that happens. Then the shell kills the browser, which would
end by itself within some seconds, removes its folders, and kills what is left of their process group.
"""

_SOCKET = "/org.chromium.Chromium.XXXXXX/SingletonSocket"
"""What the browser makes in the folder for temporary files."""

_LONGEST_SOCKET = 103
"""A socket's path has at most so many bytes (macOS; Linux takes 107)."""

_PATIENCE = 3.0
"""So long the browser and its shell may take to end [s]."""


def find() -> str | None:
    """Path of the installed browser, or None."""
    chosen = os.environ.get("EXO_PIN_CHROMIUM")
    return next((path for name in (chosen, *_NAMES) if name and (path := shutil.which(name))), None)


class GuardedBrowser:
    """A running browser that shows one blank page.

    Args:
        flags: Further command-line flags.

    Attributes:
        folder: Private folder for pages; it goes with the browser.
        commands: Pipe that the browser reads.
        answers: Pipe that the browser writes.

    Raises:
        ExoPinError: No browser is installed, or it cannot be started.
    """

    def __init__(self, flags: Sequence[str] = ()) -> None:
        command = find()
        if command is None:
            raise ExoPinError(
                f"no Chromium found (looked for {', '.join(_NAMES)}); install it, e.g. "
                "`apt install chromium`, or name it in EXO_PIN_CHROMIUM"
            )
        self._ends = ExitStack()
        try:
            self.folder = self._ends.enter_context(scratch.folder())
            self.commands, self.answers = self._start([command, *_FLAGS, *_unconfined(), *flags])
        except OSError as error:
            self.close()
            raise ExoPinError(f"{command} cannot be started: {error.strerror}") from error
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """End the browser and remove what it wrote; may be called twice."""
        self._ends.close()

    def _start(self, command: Sequence[str]) -> tuple[IO[bytes], IO[bytes]]:
        """Start the shell and the browser; the pipes for commands and answers.

        They have a session of their own: a Ctrl-C of the terminal is for this process alone.
        """
        short = self._short_folder()
        watched, alive = os.pipe()
        self._ends.callback(os.close, watched)
        life = self._ends.enter_context(os.fdopen(alive, "wb"))
        folders = [str(self.folder), str(short)]
        command = [*command, f"--user-data-dir={self.folder}/profile", "about:blank"]
        process = subprocess.Popen(
            ["/bin/sh", "-c", _GUARD, "sh", *folders, *command],
            bufsize=0,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=watched,
            env=_environment(self.folder, short),
            start_new_session=True,
        )
        self._ends.callback(_end, process, life)
        assert process.stdin is not None
        assert process.stdout is not None
        return process.stdin, process.stdout

    def _short_folder(self) -> Path:
        """A folder for the browser's temporary files whose path leaves room for the name of a socket."""
        short = self.folder / "tmp"
        if len(os.fsencode(short)) + len(_SOCKET) > _LONGEST_SOCKET:
            return self._ends.enter_context(scratch.folder(Path("/tmp")))
        short.mkdir()
        return short


def _unconfined() -> list[str]:
    """Flags for root, for whom the browser's own sandbox does not work."""
    return ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []


def _environment(folder: Path, short: Path) -> Mapping[str, str]:
    """This process's environment without proxies, and with private folders for all that a browser writes."""
    kept = {name: value for name, value in os.environ.items() if not name.lower().endswith("_proxy")}
    places = {"TMPDIR": short, "XDG_CONFIG_HOME": folder / "config", "XDG_CACHE_HOME": folder / "cache"}
    return kept | {name: str(place) for name, place in places.items()}


def _end(process: subprocess.Popen[bytes], life: IO[bytes]) -> None:
    """Let the shell end the browser; kill their group if that takes too long."""
    for pipe in (life, process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()
    try:
        with suppress(subprocess.TimeoutExpired):
            process.wait(_PATIENCE)
    finally:  # also where a signal ends the wait
        with suppress(OSError):  # there is no such group any more
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
