/* Numbers below the least normal one, 2e-308. Motion that decays along many bodies or elements ends in them, and some
 * processors take a hundred times as long with each: in the time loop they are zero. Elsewhere, in what callers
 * compute, they stay. */
#ifndef FUNICULAR_BASE_UNDERFLOW_H
#define FUNICULAR_BASE_UNDERFLOW_H

#if defined(__SSE2__)
#include <xmmintrin.h>
#define FU_TINY_IS_ZERO 0x8040u /* results and operands: FTZ and DAZ of the register MXCSR */

/* Returns how this thread takes such numbers, and all else that its register says. */
static inline unsigned fu_underflow(void)
{
    return _mm_getcsr();
}

static inline void fu_set_underflow(unsigned mode)
{
    _mm_setcsr(mode);
}

#else /* processors that take them as fast as others, or of which nothing is known */
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
