"""What must hold before a model is built: placement, conflicts, planarity."""
