/* Sums over the points of a block: forces on an element, and their derivatives. */
#include "couplings/common/point_lanes.h"
#include "couplings/fluid/drag.h"

FU_INLINE const fu_points *shapes_of_field(const fu_block_shapes *of, int field)
{
    return field == 0 ? of->N : field == 1 ? of->N_x : of->N_chord;
}

double fu_block_sum(const fu_points *x)
{
    return ((*x)[0] + (*x)[1]) + ((*x)[2] + (*x)[3]);
}

FU_INLINE void subtract_on(int dim, int n, const fu_block_shapes *shapes, int n_fields, const fu_points *forces,
                           double *f)
{
    fu_points on_vectors[FU_MAX_COORDINATES];
    for (int k = 0; k < n; ++k)
        for (int d = 0; d < dim; ++d) {
            on_vectors[k * dim + d] = shapes->N[k] * forces[d];
            for (int field = 1; field < n_fields; ++field)
                on_vectors[k * dim + d] += shapes_of_field(shapes, field)[k] * forces[field * dim + d];
        }
    fu_add_sums(n * dim, -1.0, on_vectors, f);
}

FU_INLINE void subtract(int dim, const fu_block_shapes *shapes, int n_fields, const fu_points *forces, double *f)
{
    FU_BY_SHAPES(subtract_on, dim, shapes->shapes, shapes, n_fields, forces, f);
}

FU_SIMD_FUNCTION(fu_block_subtract, subtract,
                 (int dim, const fu_block_shapes *shapes, int n_fields, const fu_points *forces, double *f),
                 (dim, shapes, n_fields, forces, f))

/* Adds to K, of all n * dim coordinates, the derivatives of the forces on n_rows fields by n_columns fields. */
FU_INLINE void add_matrix_of(int dim, int n, const fu_block_shapes *shapes, int n_rows, int n_columns,
                             const fu_points *by, double *K)
{
    const int all = n * dim, size = dim * dim;
    fu_points changes[FU_BLOCK_FIELDS * 3 * FU_MAX_COORDINATES], row[FU_MAX_COORDINATES];
    for (int field = 0; field < n_rows; ++field)
        for (int i = 0; i < dim; ++i)
            for (int l = 0; l < n; ++l)
                for (int j = 0; j < dim; ++j) {
                    const fu_points *block = by + field * n_columns * size + i * dim + j;
                    fu_points change = block[0] * shapes->N[l];
                    for (int other = 1; other < n_columns; ++other)
                        change += block[other * size] * shapes_of_field(shapes, other)[l];
                    changes[(field * dim + i) * all + l * dim + j] = change;
                }
    for (int k = 0; k < n; ++k)
        for (int i = 0; i < dim; ++i, K += all) {
            for (int m = 0; m < all; ++m) {
                row[m] = shapes->N[k] * changes[i * all + m];
                for (int field = 1; field < n_rows; ++field)
                    row[m] += shapes_of_field(shapes, field)[k] * changes[(field * dim + i) * all + m];
            }
            fu_add_sums(all, 1.0, row, K);
        }
}

FU_INLINE void by_fields(int dim, int n, const fu_block_shapes *shapes, int n_rows, int n_columns, const fu_points *by,
                         double *K)
{
    if (n_rows == 2 && n_columns == 2) add_matrix_of(dim, n, shapes, 2, 2, by, K);
    else if (n_rows == 1 && n_columns == 1) add_matrix_of(dim, n, shapes, 1, 1, by, K);
    else add_matrix_of(dim, n, shapes, n_rows, n_columns, by, K);
}

FU_INLINE void add_matrix(int dim, const fu_block_shapes *shapes, int n_rows, int n_columns, const fu_points *by,
                          double *K)
{
    FU_BY_SHAPES(by_fields, dim, shapes->shapes, shapes, n_rows, n_columns, by, K);
}

FU_SIMD_FUNCTION(fu_block_add_matrix, add_matrix,
                 (int dim, const fu_block_shapes *shapes, int n_rows, int n_columns, const fu_points *by, double *K),
                 (dim, shapes, n_rows, n_columns, by, K))
