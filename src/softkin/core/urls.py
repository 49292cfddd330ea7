"""URLs: what of them may be shown, and which hosts are this machine."""

from __future__ import annotations

import ipaddress
from urllib.parse import parse_qsl, unquote, urlsplit

#: What stands in the place of a credential.
HIDDEN = "***"


def without_credentials(url: str) -> str:
    """The `url` as it may be shown: user name, password, values of the query and fragment are hidden. What is no URL,
    such as a path, stays as it is.

    Example:
        >>> without_credentials("https://me:secret@example.org/robot.csv?token=1a2b")
        'https://***@example.org/robot.csv?token=***'
    """
    try:
        parts = urlsplit(url)
        has_credentials = "://" in url and ("@" in parts.netloc or bool(parts.query or parts.fragment))
    except ValueError:  # no URL that anything can open; it may hold a password all the same
        return HIDDEN
    if not has_credentials:
        return url
    host = parts.netloc.rpartition("@")[2]
    netloc = f"{HIDDEN}@{host}" if "@" in parts.netloc else host
    names = [pair.partition("=") for pair in parts.query.split("&") if pair]
    query = "&".join(f"{name}={HIDDEN}" if equals else HIDDEN for name, equals, _ in names)
    ends = [f"?{query}"] * bool(query) + [f"#{HIDDEN}"] * bool(parts.fragment)
    return f"{parts.scheme}://{netloc}{parts.path}{''.join(ends)}"


def credentials_in(url: str) -> list[str]:
    """What `without_credentials` hides of a `url`, as it stands there and as it is meant, longest first."""
    if without_credentials(url) == url:
        return []
    parts = urlsplit(url)
    user, _, password = parts.netloc.rpartition("@")[0].partition(":")
    values = [value for _, value in parse_qsl(parts.query, keep_blank_values=True)]
    raw = [pair.partition("=")[2] or pair for pair in parts.query.split("&")]
    found = {parts.netloc.rpartition("@")[0], user, password, parts.fragment, *values, *raw}
    return sorted({*found, *map(unquote, found)} - {""}, key=len, reverse=True)


def hide_in(text: str, *urls: str) -> str:
    """The `text`, such as the message of a library, without the credentials of `urls`.

    A credential of fewer than three characters is hidden within its URL only: elsewhere it is a part of words.
    """
    for url in urls:
        text = text.replace(url, without_credentials(url))
        for secret in credentials_in(url):
            if len(secret) > 2:
                text = text.replace(secret, HIDDEN)
    return text


def is_loopback(url: str) -> bool:
    """Whether the host of a `url` is this machine, by its name or number alone; nothing is looked up."""
    try:
        host = urlsplit(url).hostname or ""
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
