/* Impulses along the rows of hard contacts, and their jumps of velocities. */
#include "equations/equations.h"
#include "equations/run.h"
#include "events/hard_contact.h"

#include <string.h>

void fu_hard_push(fu_run *run, const fu_hard_row *row, const double *H, double impulse)
{
    for (int i = 0; i < row->n; ++i) run->before[row->at[i]] += impulse * H[i];
}

void fu_hard_respond(fu_run *run, const fu_hard_row *row, const double *H)
{
    memset(run->before, 0, sizeof(double) * (size_t)run->model->n_dof);
    fu_hard_push(run, row, H, 1.0);
    fu_response(run->model, &run->accelerator, run->before, run->work);
}

double fu_hard_rate(const fu_hard_row *row, const double *H, const double *dofs)
{
    double sum = 0.0;
    for (int i = 0; i < row->n; ++i) sum += H[i] * dofs[row->at[i]];
    return sum;
}
