/* What a coupling's structure takes from the model, described: cython/translation.pxi fills in each field from the
 * attribute of its name of the coupling's class in the package funicular.model, and knows no kind of coupling. Likewise
 * what a coupling gives to a row of output: Python finds the numbers by the names of these fields.
 */
#ifndef FUNICULAR_BASE_FIELDS_H
#define FUNICULAR_BASE_FIELDS_H

#include <stddef.h>

/* FU_INTEGER, FU_REAL: numbers. FU_LENGTH: a number, a length from which positions are computed, m. FU_WORD: the index
 * among `words` of a word. FU_KERNELS: a table of kernels by its name, null for an empty one; words[0] is its role, or
 * the name of the coupling's type where words is null. FU_ATTACHMENT: an attachment. FU_MODAL_POINT: the point of a
 * modal body, left out for None. FU_INTEGERS, FU_REALS: an array of any length, to which the structure has a pointer.
 */
enum { FU_INTEGER, FU_REAL, FU_LENGTH, FU_WORD, FU_KERNELS, FU_ATTACHMENT, FU_MODAL_POINT, FU_INTEGERS, FU_REALS };
typedef struct {
    const char *name; /* null: the last of a list */
    int kind;
    size_t offset;
    int most;                 /* items that the structure has: so many may be given */
    size_t stride;            /* bytes from one item to the next */
    const char *const *words; /* the last of them null */
} fu_field;

/* A field of one item of this name in the structure. */
#define FU_FIELD(structure, member, kind, words) {#member, kind, offsetof(structure, member), 1, 0, words}
/* A field that the model has another name for. */
#define FU_FIELD_AS(name, structure, member, kind) {name, kind, offsetof(structure, member), 1, 0, NULL}
/* A field of an array. */
#define FU_FIELD_ARRAY(structure, member, kind)                                                                        \
    {#member,                                                                                                          \
     kind,                                                                                                             \
     offsetof(structure, member),                                                                                      \
     sizeof(((structure *)0)->member) / sizeof(*((structure *)0)->member),                                             \
     sizeof(*((structure *)0)->member),                                                                                \
     NULL}

/* A number or vector in a row of output: where it begins among the coupling's numbers, how many it has, its SI unit,
 * and how other axes change it: as a "point", as a "direction", or as a direction in "body axes"; a null `turns`: not
 * at all. */
typedef struct {
    const char *name; /* null: the last of a list, whose `first` counts the numbers of all */
    int first, size;
    const char *unit, *turns;
} fu_output;

/* The output of this name in a structure of doubles, and the end of the list of its outputs. */
#define FU_OUTPUT(structure, member, unit, turns)                                                                      \
    {#member, (int)(offsetof(structure, member) / sizeof(double)),                                                     \
     (int)(sizeof(((structure *)0)->member) / sizeof(double)), unit, turns}
#define FU_LAST_OUTPUT(structure) {NULL, (int)(sizeof(structure) / sizeof(double)), 0, NULL, NULL}

#endif
