/* The types of couplings. A new one has its line here: WITH_EVENTS if it finds events. */
#include "events/list.h"

#include <string.h>

#define FU_TYPES(ALONE, WITH_EVENTS)                                                                                   \
    ALONE(dead_load)                                                                                                   \
    ALONE(load)                                                                                                        \
    ALONE(line_load)                                                                                                   \
    WITH_EVENTS(slide)                                                                                                 \
    ALONE(joint)                                                                                                       \
    ALONE(joint_friction)                                                                                              \
    WITH_EVENTS(joint_sticking)                                                                                        \
    ALONE(anchor)                                                                                                      \
    WITH_EVENTS(span)                                                                                                  \
    WITH_EVENTS(sheave)                                                                                                \
    WITH_EVENTS(wrap_point)                                                                                            \
    WITH_EVENTS(drum)                                                                                                  \
    WITH_EVENTS(taut_point)                                                                                            \
    WITH_EVENTS(taut_rope)                                                                                             \
    WITH_EVENTS(point_force)                                                                                           \
    WITH_EVENTS(drag)                                                                                                  \
    ALONE(ice)                                                                                                         \
    WITH_EVENTS(crossing)                                                                                              \
    WITH_EVENTS(contact)                                                                                               \
    ALONE(branch)                                                                                                      \
    ALONE(working_curve)                                                                                               \
    ALONE(rope_contact)                                                                                                \
    WITH_EVENTS(hard_contact)

#define DECLARE(kind) extern const fu_coupling_type fu_##kind##_type;
#define DECLARE_BOTH(kind) DECLARE(kind) extern const fu_coupling_events fu_##kind##_events;
#define ENTRY(kind) {&fu_##kind##_type, 0},
#define ENTRY_OF_BOTH(kind) {&fu_##kind##_type, &fu_##kind##_events},

FU_TYPES(DECLARE, DECLARE_BOTH)

static const struct {
    const fu_coupling_type *type;
    const fu_coupling_events *events;
} types[] = {FU_TYPES(ENTRY, ENTRY_OF_BOTH)};

const fu_coupling_type *fu_coupling_type_of(const char *name)
{
    for (size_t k = 0; k < sizeof types / sizeof *types; ++k)
        if (!strcmp(types[k].type->name, name)) return types[k].type;
    return 0;
}

const fu_coupling_type *fu_coupling_type_at(size_t k)
{
    return k < sizeof types / sizeof *types ? types[k].type : 0;
}

void fu_bind_events(fu_coupling *coupling)
{
    for (size_t k = 0; k < sizeof types / sizeof *types; ++k)
        if (types[k].type == coupling->type) coupling->events = types[k].events;
}
