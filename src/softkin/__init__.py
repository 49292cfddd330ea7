"""softkin: data-driven forward kinematics of soft robots, and how far to trust it."""

__version__ = "0.1.0"
