"""From SymPy specs to checked-in C: derivation, code generation, drift check, verification."""
