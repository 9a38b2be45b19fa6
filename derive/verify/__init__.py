"""`funicular verify`: derivatives, rounding and invariances of the generated kernels."""
