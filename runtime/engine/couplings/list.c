/* The types of couplings: a new one has its line here. */
#include "engine.h"

#include <string.h>

static const fu_coupling_type *const types[] = {&fu_dead_load_type, &fu_load_type, &fu_slide_type, &fu_joint_type,
                                                &fu_point_force_type, &fu_drag_type, &fu_crossing_type};

const fu_coupling_type *fu_coupling_type_of(const char *name)
{
    for (size_t k = 0; k < sizeof types / sizeof *types; ++k)
        if (!strcmp(types[k]->name, name)) return types[k];
    return 0;
}
