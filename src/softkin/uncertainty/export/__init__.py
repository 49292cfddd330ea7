"""Calibrated models written for other machines: a Python file that needs numpy alone, and a C header."""
