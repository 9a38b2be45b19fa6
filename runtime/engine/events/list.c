/* The types of couplings. A new one has its line here. */
#include "couplings/crossing/crossing.h"
#include "couplings/fluid/drag.h"
#include "couplings/force/loads.h"
#include "couplings/force/point_force.h"
#include "couplings/hard_contact/hard_contact.h"
#include "couplings/joint/joint.h"
#include "couplings/slide/slide.h"
#include "events/list.h"

#include <string.h>

static const struct {
    const fu_coupling_type *type;
    const fu_coupling_events *events;
} types[] = {{&fu_dead_load_type, 0},
             {&fu_load_type, 0},
             {&fu_slide_type, &fu_slide_events},
             {&fu_joint_type, 0},
             {&fu_point_force_type, &fu_point_force_events},
             {&fu_drag_type, &fu_drag_events},
             {&fu_crossing_type, &fu_crossing_events},
             {&fu_contact_type, &fu_contact_events},
             {&fu_hard_contact_type, &fu_hard_contact_events}};

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
