/* The parts of a state that belong to a slide, and the extent of its cable or span. */
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

void fu_slide_ends(const fu_model *model, const fu_state *state, int slide, double ends[2])
{
    const fu_slide *it = &model->slides[slide];
    ends[0] = it->cable < 0 ? state->q[it->on.s[0]] : 0.0;
    ends[1] = it->cable < 0 ? state->q[it->on.s[1]] : fu_cable_length(&model->cables[it->cable]);
}

double fu_length(const fu_model *model, const fu_state *state, int slide)
{
    double ends[2];
    fu_slide_ends(model, state, slide, ends);
    return ends[1] - ends[0];
}

double fu_element_start(const fu_model *model, const fu_state *state, int slide, int element)
{
    const fu_slide *it = &model->slides[slide];
    double ends[FU_SPAN_ENDS];
    if (it->cable >= 0) return fu_cable_start(&model->cables[it->cable], element);
    fu_span_at_ends(&it->on, element, state->q, ends);
    return ends[0];
}

double fu_mean_element(const fu_model *model, const fu_state *state, int slide)
{
    const fu_slide *it = &model->slides[slide];
    return it->cable < 0 ? fu_length(model, state, slide) / it->on.n_elements : model->cables[it->cable].length;
}

int fu_slide_elements(const fu_model *model, int slide)
{
    const fu_slide *it = &model->slides[slide];
    return it->cable < 0 ? it->on.n_elements : model->cables[it->cable].n_elements;
}

int fu_slide_element_coordinates(const fu_model *model, int slide)
{
    const fu_slide *it = &model->slides[slide];
    return it->cable < 0 ? it->on.kernel->coordinates + FU_SPAN_ENDS : model->cables[it->cable].coordinates;
}
