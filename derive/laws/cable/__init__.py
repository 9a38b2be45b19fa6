"""Laws of cables."""

from .cable import Cable

__all__ = ["Cable"]
