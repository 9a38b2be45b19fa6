"""Formulas: their tree, their text in LaTeX and MathML, the way back from the text, and their value."""
