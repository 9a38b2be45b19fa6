/* Complex numbers in LAPACK's layout. Some compilers (MSVC) lack C's own, whose products also handle infinities, which
 * no solution has. */
#ifndef FUNICULAR_LINEAR_COMPLEX_NUMBER_H
#define FUNICULAR_LINEAR_COMPLEX_NUMBER_H

#include <math.h>

typedef struct {
    double re, im;
} fu_complex;

static inline fu_complex fu_complex_product(fu_complex a, fu_complex b)
{
    return (fu_complex){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/* a / b by Smith's method (Communications of the ACM 5 (1962) 435), which does not square b. */
static inline fu_complex fu_complex_quotient(fu_complex a, fu_complex b)
{
    if (fabs(b.re) < fabs(b.im)) {
        const double ratio = b.re / b.im, denominator = b.re * ratio + b.im;
        return (fu_complex){(a.re * ratio + a.im) / denominator, (a.im * ratio - a.re) / denominator};
    }
    const double ratio = b.im / b.re, denominator = b.im * ratio + b.re;
    return (fu_complex){(a.im * ratio + a.re) / denominator, (a.im - a.re * ratio) / denominator};
}

/* sum += a * factor */
static inline void fu_complex_add(fu_complex *sum, fu_complex a, double factor)
{
    sum->re += a.re * factor;
    sum->im += a.im * factor;
}

/* from -= a * b */
static inline void fu_complex_subtract_product(fu_complex *from, fu_complex a, fu_complex b)
{
    const fu_complex product = fu_complex_product(a, b);
    from->re -= product.re;
    from->im -= product.im;
}

#endif
