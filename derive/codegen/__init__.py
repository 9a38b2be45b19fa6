"""From expressions to checked-in C: programs, printing, rendering, provenance, drift check, build."""
