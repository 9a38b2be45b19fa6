"""From a scene to the arrays that the engine reads."""
