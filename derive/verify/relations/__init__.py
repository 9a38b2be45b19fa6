"""What outputs of kernels are derivatives of."""
