"""Scikit-learn estimators that no library offers."""
