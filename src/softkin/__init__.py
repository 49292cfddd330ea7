"""softkin: data-driven forward kinematics of soft robots, with conformal intervals.

The public names are imported when they are first used: `import softkin` alone loads no numerical library.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from softkin.core.errors import SoftkinError
    from softkin.uncertainty.calibrated_model import CalibratedModel
    from softkin.uncertainty.loading import load

__all__ = ["CalibratedModel", "SoftkinError", "__version__", "load"]
__version__ = "0.1.0"

#: Public name -> the module that defines it.
_MODULES = {
    "CalibratedModel": "softkin.uncertainty.calibrated_model",
    "SoftkinError": "softkin.core.errors",
    "load": "softkin.uncertainty.loading",
}

if not TYPE_CHECKING:  # a type checker would accept any attribute

    def __getattr__(name: str) -> object:
        """The public name, imported from its module (PEP 562)."""
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(import_module(_MODULES[name]), name)
