/* Operations on several numbers at a time, with AVX2 if compiler and machine have it. The operations on each number are
 * those of scalar code, so that without contraction the bits are the same. */
#ifndef FUNICULAR_BASE_SIMD_H
#define FUNICULAR_BASE_SIMD_H

#define FU_SIMD_WIDTH 4
typedef double fu_simd_block
    __attribute__((vector_size(FU_SIMD_WIDTH * sizeof(double)), aligned(sizeof(double)), may_alias));

#define FU_INLINE static inline __attribute__((always_inline))
#if defined(__x86_64__) && defined(__GNUC__)
#define FU_AVX2 __attribute__((target("avx2")))
#define FU_HAS_AVX2 __builtin_cpu_supports("avx2")
#else
#define FU_AVX2
#define FU_HAS_AVX2 0
#endif

/* Defines a function without result, and a second one for AVX2, by a body that is inlined in both. */
#define FU_SIMD_FUNCTION(name, body, parameters, arguments)                                                            \
    FU_AVX2 static void name##_avx2 parameters                                                                         \
    {                                                                                                                  \
        body arguments;                                                                                                \
    }                                                                                                                  \
    static void name##_plain parameters                                                                                \
    {                                                                                                                  \
        body arguments;                                                                                                \
    }                                                                                                                  \
    void name parameters                                                                                               \
    {                                                                                                                  \
        if (FU_HAS_AVX2) name##_avx2 arguments;                                                                        \
        else name##_plain arguments;                                                                                   \
    }

#endif
