/* The arrays of states and of rows of output as lists, for code that treats all of them alike. */
#include "base/simd.h"
#include "bodies/model.h"
#include "bodies/record.h"
#include "bodies/state.h"

#include <string.h>

/* Returns whether n numbers are all finite. */
int fu_all_finite(const double *numbers, long n)
{
    fu_simd_block zero = {0.0}; /* NaN by a number that is not finite */
    long i = 0;
    for (; i + FU_SIMD_WIDTH <= n; i += FU_SIMD_WIDTH) zero += *(const fu_simd_block *)(numbers + i) * 0.0;
    for (; i < n; ++i) zero[0] += numbers[i] * 0.0;
    return zero[0] + zero[1] + zero[2] + zero[3] == 0.0;
}

#define IS_REAL(type) _Generic((type)0, double: 1, default: 0)

/* Returns the k-th array of a state of the model. */
fu_array fu_state_array(const fu_model *model, const fu_state *state, int k)
{
    const fu_array arrays[] = {
#define ENTRY(type, name, items) {#name, state->name, (items), sizeof(type), IS_REAL(type), 1},
        FU_STATE_ARRAYS(ENTRY)
#undef ENTRY
    };
    return arrays[k];
}

/* Gives a state its k-th array. */
void fu_state_attach(fu_state *state, int k, void *data)
{
    int at = 0;
#define ATTACH(type, name, items)                                                                                      \
    if (k == at++) state->name = data;
    FU_STATE_ARRAYS(ATTACH)
#undef ATTACH
}

/* Copies the couplings' part of a state except their coordinates. */
void fu_state_take_couplings(const fu_model *model, fu_state *to, const fu_state *from)
{
#define TAKE(type, name, items) memcpy(to->name, from->name, sizeof(type) * (size_t)(items));
    FU_STATE_OF_COUPLINGS(TAKE)
#undef TAKE
}

/* Returns the k-th array of the record; its items are those of a row. */
fu_array fu_record_array(const fu_model *model, const fu_record *record, int k)
{
    const fu_array arrays[] = {
#define ENTRY(name, axes, items) {#name, record->name, (items), sizeof(double), 1, axes},
        FU_RECORD_ARRAYS(ENTRY)
#undef ENTRY
    };
    return arrays[k];
}

/* Gives the record its k-th array. */
void fu_record_attach(fu_record *record, int k, double *data)
{
    int at = 0;
#define ATTACH(name, axes, items)                                                                                      \
    if (k == at++) record->name = data;
    FU_RECORD_ARRAYS(ATTACH)
#undef ATTACH
}

/* Returns whether all numbers in a row of the record's arrays are finite. */
int fu_record_is_finite(const fu_model *model, const fu_record *record, long row)
{
    for (int k = 0; k < FU_N_RECORD_ARRAYS; ++k) {
        const fu_array array = fu_record_array(model, record, k);
        if (!fu_all_finite((const double *)array.data + row * array.items, array.items)) return 0;
    }
    return 1;
}
