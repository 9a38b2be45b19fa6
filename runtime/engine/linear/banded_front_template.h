/* A front without neighbours whose matrix is a band in another order, as that of many slides on one cable: each is
 * coupled to those in the same substructures. Slides move, so that the order is found anew with each factorisation. A
 * file that includes this has defined what fronts_template.h asks for, and SUBSTITUTE(banded, x), which solves with a
 * factored band in place, in its order, and FACTOR_BAND (LAPACK's gbtrf). */

/* Lists the non-zero entries of the matrix of a front by columns; returns 0 where there are too many for a band. */
FU_INLINE int PREFIX(list_entries)(fu_banded_front *b, const NUMBER *matrix, int n)
{
    int entries = 0;
    for (int j = 0; j < n; ++j) {
        b->first[j] = entries;
        if (entries > b->most_entries - n) return 0;
        for (int i = 0; i < n; ++i, ++matrix)
            if (SIZE(*matrix) != 0.0) b->rows[entries++] = i;
    }
    b->first[n] = entries;
    return 1;
}

/* Returns the main diagonal's place for a column of the front, from which on the places of rows count. */
FU_INLINE NUMBER *PREFIX(column_of)(const fu_banded_front *b, int stride, int j)
{
    return (NUMBER *)b->band + (long)b->place[j] * stride + b->lower + b->upper - b->place[j];
}

/* Copies the entries of the matrix, and the Schur complements of the children of front k, into the band. */
FU_INLINE void PREFIX(fill_band)(const fu_fronts *t, fu_factors *f, int k, const NUMBER *matrix, int stride)
{
    const fu_banded_front *b = &f->banded;
    const int n = b->n;
    NUMBER *band = (NUMBER *)b->band;
    for (int i = 0; i < stride * n; ++i) band[i] = ZERO;
    for (int j = 0; j < n; ++j) {
        NUMBER *to = PREFIX(column_of)(b, stride, j);
        for (int e = b->first[j]; e < b->first[j + 1]; ++e) to[b->place[b->rows[e]]] = matrix[(long)j * n + b->rows[e]];
    }
    for (int c = t->child[k]; c >= 0; c = t->sibling[c]) {
        const int rest = f->size[c] - f->done[c], *in_parent = t->in_parent + t->first[c] + t->pivots[c];
        int between;
        const NUMBER *column = PREFIX(complement)(f, c, &between);
        for (int j = 0; j < rest; ++j, column += between) {
            NUMBER *to = PREFIX(column_of)(b, stride, in_parent[j]);
            for (int i = 0; i < rest; ++i) ADD(to[b->place[in_parent[i]]], column[i]);
        }
    }
}

/* Factors front k as a band; returns 0 where it is none, or where its children have delayed pivots to it. info: as of
 * LAPACK, in the order of the front. */
FU_INLINE int PREFIX(factor_banded)(const fu_fronts *t, const NUMBER *matrix, fu_factors *f, int k,
                                    const fu_lapack *lapack, int *info)
{
    fu_banded_front *b = &f->banded;
    int n = t->pivots[k];
    b->n = 0;
    for (int c = t->child[k]; c >= 0; c = t->sibling[c])
        if (f->pivots[c] != f->done[c]) return 0;
    b->is_listed = PREFIX(list_entries)(b, matrix, n);
    if (!b->is_listed) return 0;
    fu_order_band(t, b, k);
    fu_find_width(t, b, k);
    int stride = fu_banded_stride(b);
    if (2 * (stride - FU_BANDED_PADDING) > n) return 0;
    b->n = n;
    PREFIX(fill_band)(t, f, k, matrix, stride);
    lapack->FACTOR_BAND(&n, &n, &b->lower, &b->upper, b->band, &stride, b->pivot, info);
    if (*info > 0) *info = b->order[*info - 1] + 1;
    return 1;
}

/* Solves with a factored band in place; work: n numbers. */
FU_INLINE void PREFIX(solve_banded)(const fu_banded_front *b, NUMBER *x, NUMBER *work)
{
    for (int j = 0; j < b->n; ++j) work[j] = x[b->order[j]];
    SUBSTITUTE(b, work);
    for (int j = 0; j < b->n; ++j) x[b->order[j]] = work[j];
}
