"""Bound the threads that numerical libraries compute on."""

from __future__ import annotations

from contextlib import AbstractContextManager

from threadpoolctl import get_cached_controller


def limited_threads(threads: int) -> AbstractContextManager[object]:
    """A block in which the loaded numerical libraries (BLAS, OpenMP) compute on at most `threads` threads.

    Looking through everything that a process has loaded takes as long as a small fit. It is done again only when a
    module was imported since the last time, which is how libraries are loaded.

    Source: threadpoolctl 3.8, `get_cached_controller`.
    """
    limits: AbstractContextManager[object] = get_cached_controller().limit(limits=threads)
    return limits
