/* Exported scenes: runs row by row, values by name, saved states. */
#include "host/funicular.h"
#include "host/packed.h"
#include "run/run.h"
#include "base/underflow.h"
#include "events/events.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROW_TOLERANCE 1e-9  /* of the output step */
#define SHORTEST_STEP 4e-12 /* of the duration */
#define MAX_MEMORY_BITS 38  /* of the bytes of a run: beyond them its head is forged */
#define TOO_LARGE "the machine has too little memory for the scene: take fewer elements"

struct funicular {
    fu_parts parts;
    fu_run *run;
    void *allocated; /* null in the caller's memory */
    funicular_status status;
    int has_started, is_unusable, is_between; /* is_between: the last row is at no output time */
    char message[FUNICULAR_MESSAGE];
};

/* The head of a saved state. */
typedef struct {
    unsigned char digest[FU_DIGEST_BYTES]; /* of the scene */
    uint64_t size;
    uint32_t rows, is_between, check, unused; /* check: of the bytes that follow */
} saved_head;

/* Writes a message; returns 1. */
static int tell(funicular *f, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(f->message, sizeof f->message, format, arguments);
    va_end(arguments);
    return 1;
}

/* Returns the place of the memory in a run, and the bytes of both with any alignment. */
static size_t head_bytes(void)
{
    return (sizeof(funicular) + FU_PACKED_ALIGNMENT - 1) / FU_PACKED_ALIGNMENT * FU_PACKED_ALIGNMENT;
}

/* Writes a reason unless the caller does not want it; returns whether there is one. */
static int refused(const char *reason, char *message)
{
    if (reason && message) snprintf(message, FUNICULAR_MESSAGE, "%s", reason);
    return reason != 0;
}

static const fu_registry *registry_of(const funicular_scene *scene)
{
    return scene->registry;
}

size_t funicular_memory(const funicular_scene *scene, char *message)
{
    fu_parts parts;
    if (refused(fu_packed_parts(scene->bytes, scene->size, registry_of(scene)->digest, &parts), message)) return 0;
    if (parts.head->memory > SIZE_MAX / 2 || parts.head->memory >> MAX_MEMORY_BITS) {
        refused(TOO_LARGE, message);
        return 0;
    }
    return head_bytes() + (size_t)parts.head->memory + FU_PACKED_ALIGNMENT;
}

funicular *funicular_open(const funicular_scene *scene, void *memory, char *message)
{
    fu_parts parts;
    const size_t size = funicular_memory(scene, message);
    if (!size) return 0;
    void *allocated = memory ? 0 : calloc(1, size);
    if (!memory && refused(allocated ? 0 : TOO_LARGE, message)) return 0;
    char *base = memory ? memory : allocated;
    if (memory) memset(memory, 0, size);
    base += (FU_PACKED_ALIGNMENT - (uintptr_t)base % FU_PACKED_ALIGNMENT) % FU_PACKED_ALIGNMENT;
    funicular *f = (funicular *)base;
    fu_packed_parts(scene->bytes, scene->size, registry_of(scene)->digest, &parts);
    f->parts = parts;
    f->allocated = allocated;
    if (!refused(fu_packed_place(&parts, registry_of(scene), base + head_bytes(), &f->run), message)) return f;
    free(allocated);
    return 0;
}

void funicular_close(funicular *f)
{
    if (f) free(f->allocated);
}

/* Returns the kind and name of a coupling, such as: slide "trolley". */
static const char *coupling_name(const funicular *f, int k)
{
    return k >= 0 && (uint32_t)k < f->parts.head->n_couplings ? f->parts.texts + f->parts.couplings[k] : "the scene";
}

/* Sets the status where a run ends, and its message. */
static funicular_status ended(funicular *f, int status)
{
    const fu_run *run = f->run;
    const double t = run->now.t;
    const char *advice = "; the rows until then are valid";
    switch (status) {
    case FU_DONE: tell(f, "completed %.6g s", t); return FUNICULAR_DONE;
    case FU_EVENT: tell(f, "stopped by an event at t = %.6g s", t); return FUNICULAR_STOPPED;
    case FU_END_OF_CABLE:
        tell(f, "a slide ran off the end of its cable at t = %.6g s%s; give it end stops, or a longer cable", t,
             advice);
        return FUNICULAR_STOPPED;
    case FU_ROPE_LEFT:
        tell(f, "%s: its rope left it at t = %.6g s%s; run the scene in Python for the cause",
             coupling_name(f, run->left), t, advice);
        return FUNICULAR_STOPPED;
    case FU_SINGULAR:
        tell(f, "%s: the equations are singular at t = %.6g s%s; look at masses, inertias and constraints",
             coupling_name(f, run->failure.coupling), t, advice);
        return FUNICULAR_FAILED;
    case FU_UNSTABLE:
        tell(f, "the energy of the scene grows without cause at t = %.6g s%s; take a smaller step or tol", t, advice);
        return FUNICULAR_FAILED;
    default:
        tell(f, "%s: no step converged at t = %.6g s%s; take a smaller step, or run the scene in Python for the cause",
             coupling_name(f, run->failure.coupling), t, advice);
        return FUNICULAR_FAILED;
    }
}

/* Continues to the row of a time, s; returns a status of the engine. Events that do not end the run are passed. */
static int to_row(funicular *f, double time)
{
    fu_run *run = f->run;
    run->record.first = run->record.n;
    if (run->inputs && fu_give_inputs(run, time)) return FU_SINGULAR;
    for (;;) {
        const int status = fu_reach(run, time, INFINITY);
        if (status == FU_DONE) return time < run->duration ? FU_RUNNING : FU_DONE;
        if (status == FU_RUNNING) continue;
        if (status != FU_EVENT) return status;
        const int is_of_part =
            run->event.kind == FU_ACTED || run->event.kind == FU_DEFERRED || run->event.kind == FU_WENT_SLACK;
        if (is_of_part || !f->parts.stops[run->event.which]) continue;
        while (fu_take_deferred(run)) continue;
        return fu_stop(run);
    }
}

/* Computes the first row; returns a status of the engine. */
static int start(funicular *f)
{
    f->has_started = 1;
    return fu_start(f->run);
}

funicular_status funicular_step(funicular *f)
{
    if (f->is_unusable || f->status) return f->status;
    const fu_run *run = f->run;
    const double next = f->is_between ? run->recorded + run->output_step : run->record.n * run->output_step;
    const int is_start = !f->has_started;
    const int status =
        is_start ? start(f) : to_row(f, next > run->duration * (1.0 - FU_AT_ONCE) ? run->duration : next);
    if (status) return f->status = ended(f, status);
    if (!is_start && !f->is_between && run->record.n % (int)f->parts.head->every == 0) fu_pause(f->run);
    return FUNICULAR_RUNNING;
}

funicular_status funicular_reach(funicular *f, double time)
{
    const fu_run *run = f->run;
    if (!f->has_started) funicular_step(f);
    if (f->is_unusable || f->status) return f->status;
    if (!(time > run->recorded + SHORTEST_STEP * run->duration && time <= run->duration * (1.0 + ROW_TOLERANCE))) {
        tell(f, "time %.9g s is not after the last row, at %.9g s, and up to the duration %.9g s: give another one",
             time, run->recorded, run->duration);
        return f->status;
    }
    f->is_between = 1;
    const int status = to_row(f, time < run->duration ? time : run->duration);
    if (status) f->status = ended(f, status);
    return f->status;
}

funicular_status funicular_advance(funicular *f, double time)
{
    const double step = f->run->output_step, end = f->run->duration;
    const double off = fabs(time - step * floor(time / step + 0.5));
    if (!(time >= 0.0 && time <= end * (1.0 + ROW_TOLERANCE)) || (off > ROW_TOLERANCE * step && time < end)) {
        tell(f, "time %.9g s has no row: give a multiple of the output step %.9g s up to the duration %.9g s", time,
             step, end);
        return f->status;
    }
    if (f->is_between) {
        tell(f, "the last row is at no output time: call funicular_reach");
        return f->status;
    }
    while (!f->status && (!f->has_started || f->run->recorded < time - ROW_TOLERANCE * step)) funicular_step(f);
    return f->status;
}

funicular_status funicular_state(const funicular *f)
{
    return f->status;
}

double funicular_time(const funicular *f)
{
    return f->has_started ? f->run->recorded : 0.0;
}

double funicular_duration(const funicular *f)
{
    return f->run->duration;
}

double funicular_output_step(const funicular *f)
{
    return f->run->output_step;
}

const char *funicular_message(const funicular *f)
{
    return f->message;
}

int funicular_count(const funicular *f)
{
    return (int)f->parts.head->n_values;
}

int funicular_find(const funicular *f, const char *name)
{
    int low = 0, high = funicular_count(f);
    while (low < high) {
        const int middle = low + (high - low) / 2, order = strcmp(funicular_name(f, middle), name);
        if (order == 0) return middle;
        if (order < 0) low = middle + 1;
        else high = middle;
    }
    return -1;
}

static int is_reference(const funicular *f, int reference)
{
    return reference >= 0 && reference < funicular_count(f);
}

const char *funicular_name(const funicular *f, int reference)
{
    return is_reference(f, reference) ? f->parts.texts + f->parts.values[reference].name : "";
}

const char *funicular_unit(const funicular *f, int reference)
{
    return is_reference(f, reference) ? f->parts.texts + f->parts.values[reference].unit : "";
}

static int unknown(funicular *f, int reference)
{
    return tell(f, "reference %d is unknown: there are 0 to %d; funicular_find gives that of a name", reference,
                funicular_count(f) - 1);
}

int funicular_get(funicular *f, const int *references, size_t n, double *values)
{
    const fu_run *run = f->run;
    if (!f->has_started) return tell(f, "there is no row before the start: call funicular_step first");
    const long row = run->record.n - 1 - run->record.first;
    if (row != 0) return tell(f, "there is no row at t = %.6g s: it is not finite", run->now.t);
    for (size_t i = 0; i < n; ++i) {
        if (!is_reference(f, references[i])) return unknown(f, references[i]);
        const fu_value *value = &f->parts.values[references[i]];
        const double *array = fu_record_array(run->model, &run->record, (int)value->array).data;
        values[i] = value->factor * array[value->index];
    }
    return 0;
}

int funicular_set(funicular *f, const int *references, size_t n, const double *values)
{
    if (f->has_started) return tell(f, "velocities are set before the start: open the scene anew");
    for (size_t i = 0; i < n; ++i) {
        if (!is_reference(f, references[i])) return unknown(f, references[i]);
        const fu_value *value = &f->parts.values[references[i]];
        const fu_array array = fu_record_array(f->run->model, &f->run->record, (int)value->array);
        if (strcmp(array.name, "v"))
            return tell(f, "\"%s\" cannot be set: velocities can, before the start", funicular_name(f, references[i]));
        if (!isfinite(values[i])) return tell(f, "\"%s\" must be finite", funicular_name(f, references[i]));
        f->run->now.v[value->index] = value->factor * values[i];
    }
    return 0;
}

int funicular_inputs(const funicular *f)
{
    return (int)f->parts.head->n_inputs;
}

static int is_input(const funicular *f, int k)
{
    return k >= 0 && k < funicular_inputs(f);
}

const char *funicular_input_name(const funicular *f, int k)
{
    return is_input(f, k) ? f->parts.texts + f->parts.inputs[k].name : "";
}

const char *funicular_input_unit(const funicular *f, int k)
{
    return is_input(f, k) ? f->parts.texts + f->parts.inputs[k].unit : "";
}

int funicular_find_input(const funicular *f, const char *name)
{
    for (int k = 0; k < funicular_inputs(f); ++k)
        if (!strcmp(funicular_input_name(f, k), name)) return k;
    return -1;
}

double funicular_input(const funicular *f, int k)
{
    return is_input(f, k) ? fu_input_value(f->run, k) : NAN;
}

int funicular_set_input(funicular *f, int k, double value, double rate)
{
    if (!is_input(f, k))
        return tell(f, "input %d is unknown: there are %d; funicular_find_input gives that of a name", k,
                    funicular_inputs(f));
    if (!isfinite(value) || !isfinite(rate)) return tell(f, "input \"%s\" must be finite", funicular_input_name(f, k));
    if (rate != 0.0 && fu_is_position(f->run, k))
        return tell(f, "input \"%s\" is a position, which moves to its value over the next step: give no rate",
                    funicular_input_name(f, k));
    if (!f->has_started) return tell(f, "inputs are given after the start: call funicular_step first");
    fu_set_input(f->run, k, value, rate);
    return 0;
}

/* Copies the last row to or from `bytes`, unless they are null; returns its number of bytes. */
static size_t copy_row(const fu_run *run, char *to, const char *from)
{
    size_t taken = 0;
    for (int k = 0; k < FU_N_RECORD_ARRAYS; ++k) {
        const fu_array array = fu_record_array(run->model, &run->record, k);
        const size_t size = sizeof(double) * (size_t)(array.axes == 1 ? 1 : array.items);
        if (to) memcpy(to + taken, array.data, size);
        if (from) memcpy(array.data, from + taken, size);
        taken += size;
    }
    return taken;
}

size_t funicular_saved(const funicular *f)
{
    return sizeof(saved_head) + copy_row(f->run, 0, 0) + (size_t)fu_save(f->run, 0);
}

int funicular_pause_rows(const funicular *f)
{
    return (int)f->parts.head->every;
}

/* Returns the first bytes of the digest of a saved state behind its head. */
static uint32_t check_of(const char *bytes, size_t size)
{
    unsigned char digest[FU_DIGEST_BYTES];
    uint32_t check;
    fu_sha256((const unsigned char *)bytes, size, digest);
    memcpy(&check, digest, sizeof check);
    return check;
}

int funicular_save(funicular *f, void *bytes)
{
    if (!f->has_started || f->status) return tell(f, "a state is saved after a row of a run that has not ended");
    saved_head head = {.size = (uint64_t)funicular_saved(f),
                       .rows = (uint32_t)f->run->record.n,
                       .is_between = (uint32_t)f->is_between};
    char *numbers = (char *)bytes + sizeof head;
    memcpy(head.digest, f->parts.head->digest, sizeof head.digest);
    fu_pause(f->run);
    fu_save(f->run, numbers + copy_row(f->run, numbers, 0));
    head.check = check_of(numbers, (size_t)head.size - sizeof head);
    memcpy(bytes, &head, sizeof head);
    return 0;
}

int funicular_restore(funicular *f, const void *bytes, size_t size)
{
    saved_head head;
    const char *row = (const char *)bytes + sizeof head, *numbers = row + copy_row(f->run, 0, 0);
    if (size != funicular_saved(f)) return tell(f, "the saved state is of another scene, its size is another one");
    memcpy(&head, bytes, sizeof head);
    if (memcmp(head.digest, f->parts.head->digest, sizeof head.digest) || head.size != size)
        return tell(f, "the saved state is of another scene");
    if (check_of(row, size - sizeof head) != head.check || head.rows < 1 || head.is_between > 1)
        return tell(f, "the saved state is damaged: save it anew");
    if (!f->has_started) start(f);
    f->status = FUNICULAR_RUNNING;
    f->is_unusable = fu_restore(f->run, numbers, (int)head.rows, (int)head.is_between);
    f->is_between = (int)head.is_between;
    f->run->record.first = f->run->record.n - 1;
    copy_row(f->run, 0, row);
    if (!f->is_unusable) return 0;
    f->status = FUNICULAR_FAILED;
    return tell(f, "the saved state is of no state in which a run can pause: open the scene anew");
}
