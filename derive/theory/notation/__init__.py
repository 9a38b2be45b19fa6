"""Formulas: their tree, their text in LaTeX and MathML, the parser of that text, and their value."""
