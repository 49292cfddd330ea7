"""A server on loopback that misbehaves in each way that real ones do, and in some that only hostile ones do."""

from __future__ import annotations

import contextlib
import gzip
import hashlib
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

CONTENT = b'{"train": {}}' * 5000
SHA256 = hashlib.sha256(CONTENT).hexdigest()
#: Where the redirects lead.
REDIRECTS = {
    "redirect": "../good/FINGER.json",
    "redirect-ftp": "ftp://127.0.0.1/FINGER.json",
    "redirect-file": "file:///etc/passwd",
    "redirect-https": "https://127.0.0.1:9/FINGER.json",
    "redirect-away": "http://example.org/FINGER.json",
    "redirect-loop": "../redirect-loop/FINGER.json",
}


class Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        #: What was asked for, and the authorisation that came with it.
        self.requests: list[str] = []
        self.authorisations: list[str | None] = []

    def url(self, behaviour: str) -> str:
        return f"http://127.0.0.1:{self.server_port}/{behaviour}/FINGER.json"


class Handler(BaseHTTPRequestHandler):
    """Refuses HEAD: it has no `do_HEAD`."""

    server: Server

    def do_GET(self) -> None:
        behaviour = self.path.split("/")[1]
        first = behaviour not in self.server.requests
        self.server.requests.append(behaviour)
        self.server.authorisations.append(self.headers["Authorization"])
        if behaviour == "missing":
            return self.send_error(404)
        if behaviour == "busy" or (behaviour == "busy-once" and first):
            return self.send_error(503)
        if behaviour == "slow":
            time.sleep(2)
        # The client may have hung up.
        with contextlib.suppress(OSError):
            if behaviour in REDIRECTS:
                self.head(302, Location=REDIRECTS[behaviour])
            elif behaviour.startswith(("endless", "drip")):
                self.without_end(behaviour)
            else:
                self.whole(behaviour, first)
        return None

    def whole(self, behaviour: str, first: bool) -> None:
        body = b"something else" if behaviour == "wrong" else CONTENT
        if behaviour == "announced":
            return self.head(200, **{"Content-Length": "99999999999"})
        if behaviour.startswith("packed"):
            body = gzip.compress(b"0" * 20_000_000 if behaviour == "packed-bomb" else CONTENT)
            body = body[:-20] if behaviour == "packed-cut" else body
            encoding = "br" if behaviour == "packed-otherwise" else "gzip"
            self.head(200, **{"Content-Length": str(len(body)), "Content-Encoding": encoding})
        else:
            self.head(200, **{"Content-Length": str(len(body))})
        cut = behaviour == "truncated" or (behaviour == "truncated-once" and first)
        self.wfile.write(body[: len(body) // 2] if cut else body)
        return None

    def without_end(self, behaviour: str) -> None:
        if behaviour == "drip-headers":
            self.wfile.write(b"HTTP/1.0 200 OK\r\n")
        else:
            self.head(200)
        piece = b"0" * 100_000 if behaviour == "endless" else b"a"
        for _ in range(400):
            self.wfile.write(piece)
            self.wfile.flush()
            time.sleep(0.0 if behaviour == "endless" else 0.05)

    def head(self, status: int, **headers: str) -> None:
        self.send_response(status)
        for name, value in headers.items():
            self.send_header(name, value)
        self.end_headers()

    def log_message(self, *_: object) -> None:
        pass
