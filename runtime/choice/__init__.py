"""The model for a tolerance: the element, law, mesh and integrator of each cable, chosen by estimates."""
