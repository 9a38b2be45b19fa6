"""Runs, scenes, equilibria and modes as the plain data that pages, plots and exports are made of (view/animation.py)."""
