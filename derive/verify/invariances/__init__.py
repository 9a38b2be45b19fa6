"""What no motion of the frame may change."""
