"""The theory as a document, made from the specs and programs that make the kernels, and checked against these."""
