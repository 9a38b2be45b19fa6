"""Parameters adjusted to targets, and derivatives of states of rest."""
