"""What a scene is made of: data, checked by themselves, without kernels and without simulation; listed.py lists it."""
