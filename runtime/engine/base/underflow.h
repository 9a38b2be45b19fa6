/* Subnormal numbers, below 2e-308. Motion that decays along many bodies or elements leads to them, and some processors
 * need a hundred times as long for each: the time loop flushes them to zero. Callers keep them. */
#ifndef FUNICULAR_BASE_UNDERFLOW_H
#define FUNICULAR_BASE_UNDERFLOW_H

#if defined(__SSE2__)
#include <xmmintrin.h>
#define FU_TINY_IS_ZERO 0x8040u /* results and operands: FTZ and DAZ of the register MXCSR */

/* Returns this thread's mode for subnormal numbers, with the rest of its register. */
static inline unsigned fu_underflow(void)
{
    return _mm_getcsr();
}

static inline void fu_set_underflow(unsigned mode)
{
    _mm_setcsr(mode);
}

#else /* processors without a penalty, or unknown ones */
#define FU_TINY_IS_ZERO 0u

static inline unsigned fu_underflow(void)
{
    return 0;
}

static inline void fu_set_underflow(unsigned mode)
{
    (void)mode;
}
#endif

#endif
