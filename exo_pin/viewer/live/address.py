"""Where the live viewer listens, and under which host names its page is served."""

from __future__ import annotations

import contextlib
import errno
import ipaddress
import re
import socket
from urllib.parse import urlencode

from exo_pin.errors import ExoPinError

_BACKLOG = 4096
"""So many connections may wait to be accepted; with fewer, a flood delays others by seconds."""

_TRIES = 100
"""So many ports are tried, upwards from the wanted one."""


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
    for number in [port + k for k in range(_TRIES if port else 1) if port + k < 65_536]:
        try:
            return socket.create_server((str(address[0]), number), family=family, backlog=_BACKLOG)
        except OSError as error:
            refusal = error
            if error.errno == errno.EADDRNOTAVAIL:  # the next port will not help
                break
    raise ExoPinError(f"cannot listen on {host} from port {port} on: {refusal}; use another host or port")


def page_url(host: str, port: int, token: str) -> str:
    """Address of the page for a browser on this machine; an empty token is left out."""
    host = "127.0.0.1" if host in ("0.0.0.0", "::", "") else host
    query = f"?{urlencode({'token': token})}" if token else ""
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/{query}"


def is_allowed(header: str, *, host: str, loopback: bool) -> bool:
    """Whether a request with a Host header is answered.

    On loopback only loopback names are; else also literal addresses and this machine's own name, which a
    foreign web site cannot make its own (DNS rebinding).

    Args:
        header: The request's Host header.
        host: Address that the server listens on.
        loopback: Whether only this machine can reach it.
    """
    name = re.sub(r":\d+$", "", header).strip("[]").lower()
    if name in ("localhost", "127.0.0.1", "::1", host.lower()):
        return True
    if loopback:
        return False
    with contextlib.suppress(ValueError):
        return bool(ipaddress.ip_address(name))
    return name == socket.gethostname().lower()
