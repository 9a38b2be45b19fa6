/* Public: degrees of freedom and unknowns: bodies/unknowns.c. */
#ifndef FUNICULAR_BODIES_UNKNOWNS_H
#define FUNICULAR_BODIES_UNKNOWNS_H

#include "linear/linear.h"

/* Entries of model->unknown_of_dof: the unknown of a dof; FU_FIXED; or, from FU_COMBINED downwards, the number of its
 * combination of unknowns. */
enum { FU_FIXED = -1, FU_COMBINED = -2 };

/* Rows or columns of a block of a system: dofs or unknowns beyond them, numbered as by fu_add; `together`: all dofs of
 * a body, or all internal unknowns of a coupling, in sequence. */
typedef struct {
    int n;
    const int *at;
    int together;
} fu_side;

void fu_gather(const fu_model *model, const double *force, double *x);
void fu_spread(const fu_model *model, const double *x, double *dofs);
void fu_add(const fu_model *model, fu_system *system, int i, int j, double value);
void fu_add_element_matrix(const fu_model *model, int first, int n, const double *K, fu_system *system);
void fu_add_block(const fu_model *model, fu_system *system, fu_side rows, fu_side columns, double factor,
                  const double *values, int by_row, int by_column);
void fu_add_body(const fu_model *model, fu_system *system, int dof, int n, const double *values);
void fu_add_line(const fu_model *model, fu_system *system, int line, int is_row, int n, const int *at,
                 const double *value, double factor);
void fu_add_row_and_column(const fu_model *model, fu_system *system, int row, int n, const int *at, const double *value,
                           double factor);
int fu_extra(const fu_model *model, int k);
double fu_size(const fu_model *model, const double *dofs);
double fu_weighted_size(const fu_model *model, const double *weight, const double *dofs);

#endif
