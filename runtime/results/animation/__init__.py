"""Runs, scenes, equilibria and modes as plain data, of which pictures, pages and exports are made."""
