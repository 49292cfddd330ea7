"""Durations as text."""

from __future__ import annotations


def readable(seconds: float) -> str:
    """A measured duration in its two largest units: '2 h 5 min', '3 min 7 s', '4.2 s'."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def roughly(seconds: float) -> str:
    """An estimated duration, no finer than a minute: 'under a minute', '14 min', '2 h 5 min'."""
    minutes = round(seconds / 60)
    if minutes < 1:
        return "under a minute"
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"
