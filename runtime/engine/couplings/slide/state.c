/* The parts of a state that belong to a slide, and the length of its cable. */
#include "bodies/model.h"
#include "couplings/common/accelerator.h"
#include "couplings/slide/slide.h"

const char *const fu_end_stop_kinds[] = {"error", "leave", "hard", "buffer", 0};

fu_slide_flags *fu_slide_flags_of(const fu_model *model, const fu_state *state, int j)
{
    return (fu_slide_flags *)(state->flags + model->slides[j].base.flags);
}

fu_slide_numbers *fu_slide_numbers_of(const fu_model *model, const fu_state *state, int j)
{
    return (fu_slide_numbers *)(state->numbers + model->slides[j].base.numbers);
}

fu_slide_state *fu_slide_state_of(const fu_model *model, const fu_accelerator *work, int j)
{
    return (fu_slide_state *)(work->scratch + model->slides[j].base.scratch);
}

/* Returns the length of the cable of a slide, m. */
double fu_length(const fu_model *model, int slide)
{
    return fu_cable_length(&model->cables[model->slides[slide].cable]);
}

/* Returns the arc-length at the first node of an element of a slide's cable, m. */
double fu_element_start(const fu_model *model, int slide, int element)
{
    return fu_cable_start(&model->cables[model->slides[slide].cable], element);
}
