/* The functions of LAPACK by number, so that their one list in linear.h fills the structure. */
#include "linear/linear.h"

#include <string.h>

/* Returns the name of the k-th function, null after the last one. */
const char *fu_lapack_name(int k)
{
    static const char *const names[] = {
#define NAME(name, ...) #name,
        FU_LAPACK_FUNCTIONS(NAME)
#undef NAME
    };
    return k < (int)(sizeof names / sizeof *names) ? names[k] : 0;
}

/* Sets the k-th function. ISO C has no conversion of a pointer to data into one to a function, but both have one size.
 */
void fu_lapack_attach(fu_lapack *lapack, int k, const void *function)
{
    int at = 0;
#define ATTACH(name, ...)                                                                                              \
    if (k == at++) memcpy(&lapack->name, &function, sizeof function);
    FU_LAPACK_FUNCTIONS(ATTACH)
#undef ATTACH
}
