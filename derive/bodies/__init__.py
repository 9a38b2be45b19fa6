"""Body specs: how configuration and velocity of a body give its points and its inertia."""
