"""A port to listen on: the wanted one, or the next that is free."""

from __future__ import annotations

import errno
import socket

from exo_pin.errors import ExoPinError

TRIES = 100
"""So many ports are tried, upwards from the one asked for."""


def listen(host: str, port: int) -> socket.socket:
    """A listening socket at the wanted port, or the next free one; port 0: any.

    Raises:
        ExoPinError: The host is not an address of this machine, or no port is free.
    """
    try:
        family, *_, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, UnicodeError) as error:
        raise ExoPinError(f"{host!r} is not an address of this machine: {error}") from error
    refusal: OSError | None = None
    for number in [port + k for k in range(TRIES if port else 1) if port + k < 65_536]:
        try:
            return socket.create_server((str(address[0]), number), family=family, backlog=128)
        except OSError as error:
            refusal = error
            if error.errno == errno.EADDRNOTAVAIL:  # the next port will not help
                break
    raise ExoPinError(f"cannot listen on {host} from port {port} on: {refusal}; use another host or port")
