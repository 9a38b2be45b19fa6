"""The algebra that specs share: Gram products, section integrals, frames, discrete gradients."""
