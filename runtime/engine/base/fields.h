/* Descriptions of the fields of a coupling's structure: cython/translation.pxi fills each field from the attribute of
 * its name in the coupling's class in the package funicular.model, without knowing kinds of couplings. Outputs are
 * described likewise: Python finds them by the names of these fields. */
#ifndef FUNICULAR_BASE_FIELDS_H
#define FUNICULAR_BASE_FIELDS_H

#include <stddef.h>

/* FU_INTEGER, FU_REAL: numbers. FU_LENGTH: a length from which positions are computed, m. FU_WORD: the index of a word
 * among `words`. FU_KERNELS: a table of kernels by its name, null if empty; words[0] is its role, or the name of the
 * coupling's type if words is null. FU_ATTACHMENT: an attachment. FU_INTEGERS, FU_REALS: an array of
 * any length, to which the structure has a pointer. */
enum { FU_INTEGER, FU_REAL, FU_LENGTH, FU_WORD, FU_KERNELS, FU_ATTACHMENT, FU_INTEGERS, FU_REALS };
typedef struct {
    const char *name; /* null ends a list */
    int kind;
    size_t offset;
    int most;                 /* number of items in the structure, the maximum */
    size_t stride;            /* bytes from one item to the next */
    const char *const *words; /* ended by null */
} fu_field;

/* A field of one item of this name in the structure. */
#define FU_FIELD(structure, member, kind, words) {#member, kind, offsetof(structure, member), 1, 0, words}
/* A field with another name in the model. */
#define FU_FIELD_AS(name, structure, member, kind) {name, kind, offsetof(structure, member), 1, 0, NULL}
/* A field of an array. */
#define FU_FIELD_ARRAY(structure, member, kind)                                                                        \
    {#member,                                                                                                          \
     kind,                                                                                                             \
     offsetof(structure, member),                                                                                      \
     sizeof(((structure *)0)->member) / sizeof(*((structure *)0)->member),                                             \
     sizeof(*((structure *)0)->member),                                                                                \
     NULL}

/* A number or vector in a row of output: its first component among those of the coupling, their number, its SI unit,
 * and its transformation to other axes: as a "point", as a "direction", or as a direction in "body axes"; null:
 * none. */
typedef struct {
    const char *name; /* null ends a list; its `first` is the number of all components */
    int first, size;
    const char *unit, *turns;
} fu_output;

/* The output of this name in a structure of doubles, and the end of the list of its outputs. */
#define FU_OUTPUT(structure, member, unit, turns)                                                                      \
    {#member, (int)(offsetof(structure, member) / sizeof(double)),                                                     \
     (int)(sizeof(((structure *)0)->member) / sizeof(double)), unit, turns}
#define FU_LAST_OUTPUT(structure) {NULL, (int)(sizeof(structure) / sizeof(double)), 0, NULL, NULL}

#endif
