"""Forces and moments in sections of cables."""
