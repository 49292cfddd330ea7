"""Our own scikit-learn estimators: what no library offers."""
