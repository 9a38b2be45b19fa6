"""Laws of cables."""
