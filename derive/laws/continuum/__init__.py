"""Laws of continua."""
