/* Public: a packed scene, the memory of a run before its start as bytes that can be placed anywhere: host/packed.c;
 * funicular/export/image.py writes them. A program runs them by host/funicular.h. */
#ifndef FUNICULAR_HOST_PACKED_H
#define FUNICULAR_HOST_PACKED_H

#include "base/sha256.h"
#include "equations/run.h"
#include "linear/plain_lapack.h"

#include <stdint.h>

#define FU_PACKED_VERSION 1
#define FU_PACKED_MAGIC "funpack"
#define FU_PACKED_ALIGNMENT 64 /* of the memory, bytes: a line of the cache */

/* The head of the bytes. Its parts follow it in the order of their counts; then the numbers of the segments, and texts,
 * each of which ends with a zero byte. Offsets and sizes are in bytes and multiples of 8. */
typedef struct {
    char magic[8];
    uint32_t version, layout;              /* layout: fu_packed_layout() */
    unsigned char digest[FU_DIGEST_BYTES]; /* SHA-256 of all that follows it */
    uint64_t size, memory, run;            /* of the bytes; of the memory; place of fu_run in it */
    uint64_t numbers, texts;               /* bytes of both */
    uint32_t n_segments, n_addresses, n_links, n_values, n_couplings, n_stops;
    uint32_t n_inputs;
    uint32_t every; /* rows between the pauses of the run (fu_pause) */
} fu_packed;

typedef struct {
    uint64_t at, size;
} fu_segment; /* memory that is not zero at the start */
typedef struct {
    uint64_t at, to;
} fu_address; /* the word `at` has the address of `to` */
typedef struct {
    uint64_t at;
    uint32_t role, name;
} fu_link; /* the word `at` has the address of a table of the program; texts */

/* A number of a row by name: factor times an entry of an array of the record. */
typedef struct {
    uint32_t name, unit; /* texts */
    uint32_t array, index;
    double factor;
} fu_value;

/* An input of the run; texts */
typedef struct {
    uint32_t name, unit;
} fu_named_input;

/* A table of kernels of the program; a list ends with one without a role. */
typedef struct {
    const char *role, *name;
    const void *entry;
} fu_linked;

/* What a program has for one scene: the digest of its bytes, its kernels, and LAPACK. */
typedef struct {
    const unsigned char *digest;
    const fu_linked *kernels;
    const fu_lapack *lapack;
} fu_registry;

/* The parts of checked bytes. */
typedef struct {
    const fu_packed *head;
    const fu_segment *segments;
    const fu_address *addresses;
    const fu_link *links;
    const fu_value *values;    /* sorted by name */
    const uint32_t *couplings; /* texts: kind and name of each */
    const uint32_t *stops;     /* per event function of the user: whether it ends the run */
    const fu_named_input *inputs;
    const unsigned char *numbers; /* of the segments, one after the other */
    const char *texts;
} fu_parts;

/* Identifies the sizes of the structures of this build. */
uint32_t fu_packed_layout(void);
/* Checks bytes, aligned to 8, and finds their parts; returns null, or why they are refused. digest: of the scene. */
const char *fu_packed_parts(const void *bytes, size_t size, const unsigned char *digest, fu_parts *parts);
/* Places a scene in memory of head->memory bytes of zeros, aligned to FU_PACKED_ALIGNMENT; returns null, or why it is
 * refused.
 */
const char *fu_packed_place(const fu_parts *parts, const fu_registry *registry, void *memory, fu_run **run);

#endif
