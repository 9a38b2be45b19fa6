/* Private: sine, cosine and exponential of a number of each point of a block, inlined.
 *
 * Arguments are reduced by multiples of pi/2 and of log 2, which are sums of numbers with trailing zeros, so that their
 * products are exact (Cody & Waite, Software Manual for the Elementary Functions, 1980); on the remainder, of at most
 * pi/4 and log(2)/2, Taylor's series end below rounding. Errors are some units of the last place, for |theta| < 1e6
 * and exponents from -700 to 0.
 */
#ifndef FUNICULAR_COUPLINGS_COMMON_POINT_FUNCTIONS_H
#define FUNICULAR_COUPLINGS_COMMON_POINT_FUNCTIONS_H

#include "couplings/common/point_lanes.h"

typedef long long fu_point_bits __attribute__((vector_size(8 * FU_BLOCK_POINTS)));

#define FU_TO_INTEGER 6755399441055744.0 /* 1.5 2^52: the sum with it is rounded to an integer, in its lowest bits */
#define FU_HALF_PI_1 0x1.921fb544p+0
#define FU_HALF_PI_2 0x1.0b4611a6p-34
#define FU_HALF_PI_3 0x1.3198a2e037073p-69
#define FU_LOG2_1 0x1.62e42feep-1
#define FU_LOG2_2 0x1.a39ef35793c76p-33
#define FU_PI 3.14159265358979323846
#define FU_LOG2 0.69314718055994530942

/* A number of the first block where the mask is all ones, of the second where it is zero. Functions return no blocks:
 * how they would depends on the vectors that the compiler may use. */
#define FU_CHOSEN(mask, first, second)                                                                                 \
    ((fu_points)(((mask) & (fu_point_bits)(first)) | (~(mask) & (fu_point_bits)(second))))

/* Computes cosine and sine. */
FU_INLINE void fu_cosine_and_sine(const fu_points *theta, fu_points *cosine, fu_points *sine)
{
    const fu_points rounded = *theta * (2.0 / FU_PI) + FU_TO_INTEGER, n = rounded - FU_TO_INTEGER;
    const fu_points x = ((*theta - n * FU_HALF_PI_1) - n * FU_HALF_PI_2) - n * FU_HALF_PI_3, y = x * x;
    const fu_point_bits quarter = (fu_point_bits)rounded, odd = -(quarter & 1);
    fu_points s = {0.0}, c = {0.0};
#define FU_TERM(k) 1.0 - y * (1.0 / ((k) * ((k) + 1.0))) *
    s = FU_TERM(2)(FU_TERM(4)(FU_TERM(6)(FU_TERM(8)(FU_TERM(10)(FU_TERM(12)(FU_TERM(14)(FU_TERM(16)(s + 1.0))))))));
    c = FU_TERM(1)(FU_TERM(3)(FU_TERM(5)(FU_TERM(7)(FU_TERM(9)(FU_TERM(11)(FU_TERM(13)(FU_TERM(15)(c + 1.0))))))));
#undef FU_TERM
    s *= x;
    *sine = (fu_points)((fu_point_bits)FU_CHOSEN(odd, c, s) ^ ((quarter & 2) << 62));
    *cosine = (fu_points)((fu_point_bits)FU_CHOSEN(odd, s, c) ^ (((quarter + 1) & 2) << 62));
}

/* Computes the exponential. */
FU_INLINE void fu_exponential(const fu_points *exponent, fu_points *result)
{
    const fu_points rounded = *exponent * (1.0 / FU_LOG2) + FU_TO_INTEGER, n = rounded - FU_TO_INTEGER;
    const fu_points x = (*exponent - n * FU_LOG2_1) - n * FU_LOG2_2;
    fu_points e = {0.0};
#define FU_TERM(k) 1.0 + x * (1.0 / (k)) *
    e = FU_TERM(6)(FU_TERM(7)(FU_TERM(8)(FU_TERM(9)(FU_TERM(10)(FU_TERM(11)(FU_TERM(12)(FU_TERM(13)(e + 1.0))))))));
    e = FU_TERM(1)(FU_TERM(2)(FU_TERM(3)(FU_TERM(4)(FU_TERM(5)(e)))));
#undef FU_TERM
    *result = (fu_points)((fu_point_bits)e + ((fu_point_bits)rounded << 52));
}

#endif
