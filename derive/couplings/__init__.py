"""Joint specs: constraints and everything that follows from them by differentiation."""
