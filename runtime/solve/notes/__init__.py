"""Notes on the errors of runs and states of rest: quantity, limit, cause and remedy.

Why they stay. A result beyond the validity of its model or mesh comes with a message for the user who sees numbers and
no error: 15 quantities are measured along a run, 7 of them also at rest, beside notes on step size, integrator and
failure. The notes take 1 to 5 ms of a run of 1 s: 0.7 to 11 % of its wall time in five bundled scenes of 22 to 694 ms.
One generic warning could state neither part nor remedy, and ``estimate=True``, which runs a scene again, reports an
error without its cause.
"""
