"""The generated kernels and their manifests, of this package and of users' libraries."""
