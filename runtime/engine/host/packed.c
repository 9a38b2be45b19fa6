/* Packed scenes: checks of their bytes, and their place in memory. */
#include "host/packed.h"
#include "couplings/common/attachments.h"
#include "couplings/common/coupling_events.h"
#include "couplings/common/couplings.h"
#include "couplings/common/proximity.h"
#include "events/list.h"
#include "integrators/list.h"
#include "run/run.h"

#include <string.h>

#define WORD sizeof(uint64_t)

/* Returns the next value of a hash by Fowler, Noll and Vo. */
static uint32_t mixed(uint32_t hash, size_t number)
{
    return (hash ^ (uint32_t)number) * 16777619u;
}

uint32_t fu_packed_layout(void)
{
    const size_t sizes[] = {sizeof(void *),    sizeof(long),        sizeof(fu_packed),     sizeof(fu_run),
                            sizeof(fu_model),  sizeof(fu_cable),    sizeof(fu_body),       sizeof(fu_shape),
                            sizeof(fu_motion), sizeof(fu_signal),   sizeof(fu_attachment), sizeof(fu_breakpoint),
                            sizeof(fu_system), sizeof(fu_rows),     sizeof(fu_fronts),     sizeof(fu_record),
                            sizeof(fu_state),  sizeof(fu_proximity)};
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) hash = mixed(hash, sizes[i]);
    for (size_t k = 0; fu_coupling_type_at(k); ++k) hash = mixed(hash, fu_coupling_type_at(k)->size);
    return mixed(hash, sizeof(fu_linear_model));
}

/* Takes the next part of the bytes, of n items of a size; null if it does not fit. */
static const void *part(const char **at, size_t *left, uint64_t n, size_t size)
{
    if (n > *left / size) return 0;
    const size_t bytes = ((size_t)n * size + WORD - 1) / WORD * WORD;
    if (bytes > *left) return 0;
    const char *found = *at;
    *at += bytes;
    *left -= bytes;
    return found;
}

/* Returns whether a range lies within the memory, in whole words. */
static int is_in(const fu_packed *head, uint64_t at, uint64_t size)
{
    return at % WORD == 0 && size % WORD == 0 && at <= head->memory && size <= head->memory - at;
}

/* Returns whether all offsets of the parts are possible. */
static int are_possible(const fu_parts *p)
{
    const fu_packed *head = p->head;
    uint64_t numbers = 0;
    if (!is_in(head, head->run, sizeof(fu_run)) || head->memory % FU_PACKED_ALIGNMENT) return 0;
    if (!head->texts || p->texts[head->texts - 1]) return 0;
    for (uint32_t i = 0; i < head->n_segments; ++i) {
        if (!is_in(head, p->segments[i].at, p->segments[i].size)) return 0;
        if (p->segments[i].size > head->numbers - numbers) return 0;
        numbers += p->segments[i].size;
    }
    for (uint32_t i = 0; i < head->n_addresses; ++i)
        if (!is_in(head, p->addresses[i].at, WORD) || p->addresses[i].to >= head->memory) return 0;
    for (uint32_t i = 0; i < head->n_links; ++i)
        if (!is_in(head, p->links[i].at, WORD) || p->links[i].role >= head->texts || p->links[i].name >= head->texts)
            return 0;
    for (uint32_t i = 0; i < head->n_values; ++i)
        if (p->values[i].name >= head->texts || p->values[i].unit >= head->texts ||
            p->values[i].array >= FU_N_RECORD_ARRAYS)
            return 0;
    for (uint32_t i = 0; i < head->n_couplings; ++i)
        if (p->couplings[i] >= head->texts) return 0;
    for (uint32_t i = 0; i < head->n_inputs; ++i)
        if (p->inputs[i].name >= head->texts || p->inputs[i].unit >= head->texts) return 0;
    return numbers == head->numbers;
}

const char *fu_packed_parts(const void *bytes, size_t size, const unsigned char *digest, fu_parts *p)
{
    const fu_packed *head = p->head = bytes;
    unsigned char found[FU_DIGEST_BYTES];
    const size_t covered = offsetof(fu_packed, size);
    if (!bytes || (uintptr_t)bytes % WORD) return "the packed scene is not aligned to 8 bytes: align its array";
    if (size < sizeof *head || memcmp(head->magic, FU_PACKED_MAGIC, sizeof head->magic))
        return "these bytes are no packed scene: export the scene anew";
    if (head->version != FU_PACKED_VERSION)
        return "the packed scene is of another version of its format: export the scene anew, with its engine";
    if (head->layout != fu_packed_layout())
        return "the packed scene is of another engine, or of a machine with other sizes of numbers: export the scene "
               "anew, with its engine";
    if (head->size != size) return "the packed scene is damaged, its size is another one: export the scene anew";
    fu_sha256((const unsigned char *)bytes + covered, size - covered, found);
    if (memcmp(found, head->digest, sizeof found))
        return "the packed scene is damaged, its checksum is another one: export the scene anew";
    if (memcmp(found, digest, sizeof found))
        return "the packed scene is not the one that this program was made for: take its own, or export the scene anew";
    const char *at = (const char *)(head + 1);
    size_t left = size - sizeof *head;
    if (!(p->segments = part(&at, &left, head->n_segments, sizeof *p->segments)) ||
        !(p->addresses = part(&at, &left, head->n_addresses, sizeof *p->addresses)) ||
        !(p->links = part(&at, &left, head->n_links, sizeof *p->links)) ||
        !(p->values = part(&at, &left, head->n_values, sizeof *p->values)) ||
        !(p->couplings = part(&at, &left, head->n_couplings, sizeof *p->couplings)) ||
        !(p->stops = part(&at, &left, head->n_stops, sizeof *p->stops)) ||
        !(p->inputs = part(&at, &left, head->n_inputs, sizeof *p->inputs)) ||
        !(p->numbers = part(&at, &left, head->numbers, 1)) || !(p->texts = part(&at, &left, head->texts, 1)) || left ||
        !are_possible(p))
        return "the packed scene has impossible sizes or places: export the scene anew";
    return 0;
}

/* Returns the events of a type of coupling; null if it has none. */
static const void *events_of(const char *name)
{
    fu_coupling coupling = {.type = fu_coupling_type_of(name)};
    if (coupling.type) fu_bind_events(&coupling);
    return coupling.events;
}

/* Finds a table of the program by its role and name; returns nonzero if there is none. */
static int find(const fu_registry *registry, const char *role, const char *name, const void **found)
{
    if (!strcmp(role, "coupling")) *found = fu_coupling_type_of(name);
    else if (!strcmp(role, "events")) *found = events_of(name);
    else if (!strcmp(role, "integrator")) *found = fu_integrator_of(name);
    else if (!strcmp(role, "matter")) *found = strcmp(name, "rigid") ? &fu_modal_matter : &fu_rigid_matter;
    else if (!strcmp(role, "lapack")) *found = registry->lapack;
    else if (!strcmp(role, "blocks")) {
        *found = fu_blocks_of(name); /* null on machines without them */
        return 0;
    } else {
        *found = 0;
        for (const fu_linked *k = registry->kernels; k->role; ++k)
            if (!strcmp(k->role, role) && !strcmp(k->name, name)) *found = k->entry;
    }
    return !*found;
}

/* Returns whether the values of a row are entries of its arrays. */
static int are_values_of(const fu_parts *p, const fu_run *run, uintptr_t base)
{
    const uintptr_t model = (uintptr_t)run->model - base;
    if ((uintptr_t)run->model < base || !is_in(p->head, model, sizeof *run->model)) return 0;
    for (uint32_t i = 0; i < p->head->n_values; ++i) {
        const fu_array array = fu_record_array(run->model, &run->record, (int)p->values[i].array);
        if (p->values[i].index >= (unsigned long)(array.axes == 1 ? 1 : array.items)) return 0;
    }
    if (p->head->n_inputs != (uint32_t)(run->inputs ? run->inputs->n : 0)) return 0;
    return p->head->n_couplings == (uint32_t)run->model->n_couplings &&
           p->head->n_stops <= (uint32_t)run->n_event_functions;
}

const char *fu_packed_place(const fu_parts *p, const fu_registry *registry, void *memory, fu_run **run)
{
    char *base = memory;
    const unsigned char *numbers = p->numbers;
    for (uint32_t i = 0; i < p->head->n_segments; ++i) {
        memcpy(base + p->segments[i].at, numbers, (size_t)p->segments[i].size);
        numbers += p->segments[i].size;
    }
    for (uint32_t i = 0; i < p->head->n_addresses; ++i) {
        const void *to = base + p->addresses[i].to;
        memcpy(base + p->addresses[i].at, &to, sizeof to);
    }
    for (uint32_t i = 0; i < p->head->n_links; ++i) {
        const void *to;
        if (find(registry, p->texts + p->links[i].role, p->texts + p->links[i].name, &to))
            return "the program lacks kernels of the packed scene: export the scene anew, with its engine";
        memcpy(base + p->links[i].at, &to, sizeof to);
    }
    *run = (fu_run *)(base + p->head->run);
    return are_values_of(p, *run, (uintptr_t)base)
               ? 0
               : "the packed scene names values that it has not: export the scene anew";
}
