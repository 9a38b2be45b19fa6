"""The model for a tolerance: element, law and mesh of each cable, and the integrator, chosen by estimates.

Why it stays. A user states a tolerance instead of elements, and gets a run that keeps it, or a message. No fixed rule
does this: chosen meshes have 2 to 256 elements. Measured on 21 scenes with tolerances of 1e-2 to 1e-4
(tests/benchmarks/model_choice.py): the median error is 0.37 tol, the median cost of a run is 1.2 times that of the
cheapest model found by brute force, and the choice costs 0.3 to 22 times its run, 3.8 in the median: 0.01 to 0.2 s of
CPU for runs of some ms, 2 s for a robot with eight cables. The argument ``estimate=True`` of a run is cheaper, but it
gives the error of one mesh without a remedy. Each indicator guards against an error that no comparison of meshes shows:
shear, which cable elements lack; waves shorter than all meshes; steps of generalised-alpha that fine meshes need
shorter. Unequal elements are tried on request; taut cables between clamps then need 0.3 to 0.4 of the elements
(tests/benchmarks/unequal.py).
"""
