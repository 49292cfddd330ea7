"""Calibrated models as plain numbers: what an exported model and a single command are answered from."""
