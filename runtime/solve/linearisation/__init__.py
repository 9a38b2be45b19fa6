"""Linear models of motion about a state of rest."""
