/* Public: scenes exported by funicular as programs in C11 or C++17: host/funicular.c.
 *
 *     funicular *crane = funicular_open(&scene, NULL, error);
 *     while (funicular_step(crane) == FUNICULAR_RUNNING) ... funicular_get(crane, ...);
 *     funicular_close(crane);
 *
 * A program may open a scene any number of times; each of these runs has its own memory and state, and threads may
 * compute different ones at the same time. Nothing is allocated after funicular_open. All quantities are in SI units.
 */
#ifndef FUNICULAR_H
#define FUNICULAR_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FUNICULAR_VERSION 1   /* of this interface */
#define FUNICULAR_MESSAGE 512 /* bytes of a message */

/* An exported scene; the C file of the scene has one. */
typedef struct {
    const void *bytes; /* the packed scene */
    size_t size;
    const void *registry; /* the kernels of the scene */
} funicular_scene;

/* A run of a scene. */
typedef struct funicular funicular;

typedef enum {
    FUNICULAR_RUNNING = 0, /* the row of an output time has been computed */
    FUNICULAR_DONE = 1,    /* the row of the end of the run as well */
    FUNICULAR_STOPPED = 2, /* an event ended the run, a slide ran off its cable, or a rope left a sheave */
    FUNICULAR_FAILED = 3   /* there is no solution; the rows before are valid */
} funicular_status;

/* Returns the bytes of memory of a run; 0 if the scene is refused. message: null, or FUNICULAR_MESSAGE bytes that take
 * the reason. */
size_t funicular_memory(const funicular_scene *scene, char *message);
/* Returns a run that has not started, in the caller's memory of funicular_memory bytes, or in allocated memory if that
 * is null; null if the scene is refused. */
funicular *funicular_open(const funicular_scene *scene, void *memory, char *message);
/* Frees the memory that funicular_open has allocated. */
void funicular_close(funicular *f);

/* Computes the next row; the first call computes that of the start. */
funicular_status funicular_step(funicular *f);
/* Computes the rows until `time`, s, which is a multiple of the output step up to 1e-9 of it. */
funicular_status funicular_advance(funicular *f, double time);
/* Continues to any time after the last row, s, up to the duration, and computes its row. From there on funicular_step
 * computes a row after each output step. */
funicular_status funicular_reach(funicular *f, double time);
funicular_status funicular_state(const funicular *f);
double funicular_time(const funicular *f);        /* s: of the last row */
double funicular_duration(const funicular *f);    /* s: of the run */
double funicular_output_step(const funicular *f); /* s: between rows */
/* Returns the message of the last error or of the end of the run, which says place, cause and remedy; empty if none. */
const char *funicular_message(const funicular *f);

/* Values of a row, such as "A.position.x", "energy.kinetic" or "wire.nodal_vectors[3].r.y": their number, the reference
 * of a name or -1, and name and unit of a reference. References stay the same for an exported scene. */
int funicular_count(const funicular *f);
int funicular_find(const funicular *f, const char *name);
const char *funicular_name(const funicular *f, int reference);
const char *funicular_unit(const funicular *f, int reference);
/* Gets n values of the last row; returns nonzero, with a message, if a reference is unknown or there is no row. */
int funicular_get(funicular *f, const int *references, size_t n, double *values);
/* Sets velocities, such as "A.velocity.x", before the start; returns nonzero, with a message, for other values. Joints
 * may change them. */
int funicular_set(funicular *f, const int *references, size_t n, const double *values);

/* Inputs, such as "push.value.x", which begin with the values of the scene: their number, the number of a name or -1,
 * names and units, values. After the start an input is given a value from the last row on, and a rate, 1/s, with which
 * it goes on. Forces, torques and velocities of drives jump to it; a position, such as the angle of a joint, moves to
 * it over the next step with a constant velocity, and takes no rate. Returns nonzero, with a message, if that is
 * impossible. */
int funicular_inputs(const funicular *f);
int funicular_find_input(const funicular *f, const char *name);
const char *funicular_input_name(const funicular *f, int k);
const char *funicular_input_unit(const funicular *f, int k);
double funicular_input(const funicular *f, int k);
int funicular_set_input(funicular *f, int k, double value, double rate);

/* Saves the state after a row to funicular_saved bytes, and restores it in a run of the same scene, which continues
 * with the same bits as the run that saved it. Both return nonzero, with a message, if that is impossible; a run whose
 * restored bytes are refused has failed. After a row whose number, from 0, is not one less than a multiple of
 * funicular_pause_rows, saving changes later rows, within the tolerance. */
size_t funicular_saved(const funicular *f);
int funicular_pause_rows(const funicular *f);
int funicular_save(funicular *f, void *bytes);
int funicular_restore(funicular *f, const void *bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
