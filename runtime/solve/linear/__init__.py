"""Linear algebra of solutions: spectra, inertia of matrices, condensation, threads."""
