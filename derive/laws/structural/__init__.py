"""Laws of structural beams."""
