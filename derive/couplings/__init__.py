"""Specs of couplings: constraints, energies and forces, and their derivatives."""
