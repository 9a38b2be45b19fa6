/* The order in which a front is a band, by Cuthill and McKee (1969), from its non-zero entries. */
#include "linear/fronts.h"

/* Puts an unknown at the end of the order unless it has a place; returns the number of unknowns in the order. */
static int append(fu_banded_front *b, int i, int count)
{
    if (b->place[i] >= 0) return count;
    b->place[i] = count;
    b->order[count] = i;
    return count + 1;
}

/* Sorts a part of the order by the number of entries in a column, fewest first. */
static void sort(fu_banded_front *b, int from, int end)
{
    for (int k = from + 1; k < end; ++k) {
        const int i = b->order[k], entries = b->first[i + 1] - b->first[i];
        int at = k;
        for (; at > from && b->first[b->order[at - 1] + 1] - b->first[b->order[at - 1]] > entries; --at) {
            b->order[at] = b->order[at - 1];
            b->place[b->order[at]] = at;
        }
        b->order[at] = i;
        b->place[i] = at;
    }
}

/* Puts the unknowns that are connected to `from` into the order from `count` on, by their distance from it, of equal
 * ones those with few entries first; returns the number of unknowns in the order. */
static int reach(const fu_fronts *t, fu_banded_front *b, int from, int count)
{
    int next = count;
    count = append(b, from, count);
    while (next < count) {
        const int j = b->order[next++], c = b->child[j], begin = count;
        for (int e = b->first[j]; e < b->first[j + 1]; ++e) count = append(b, b->rows[e], count);
        for (int i = 0; c >= 0 && i < t->neighbours[c]; ++i)
            count = append(b, t->in_parent[t->first[c] + t->pivots[c] + i], count);
        sort(b, begin, count);
    }
    return count;
}

/* Finds the order of the unknowns of front k: from the one that is farthest from the first of those connected, by
 * entries of the matrix or by a child. Entries on one side of the diagonal alone are not seen from both unknowns, nor
 * more than one child of an unknown: the band may be wider then. */
void fu_order_band(const fu_fronts *t, fu_banded_front *b, int k)
{
    const int n = t->pivots[k];
    int count = 0;
    for (int i = 0; i < n; ++i) b->place[i] = b->child[i] = -1;
    for (int c = t->child[k]; c >= 0; c = t->sibling[c])
        for (int i = 0; i < t->neighbours[c]; ++i) b->child[t->in_parent[t->first[c] + t->pivots[c] + i]] = c;
    for (int i = 0; i < n; ++i) {
        if (b->place[i] >= 0) continue;
        const int end = reach(t, b, i, count), farthest = b->order[end - 1];
        for (int at = count; at < end; ++at) b->place[b->order[at]] = -1;
        count = reach(t, b, farthest, count);
        if (b->place[i] < 0) count = reach(t, b, i, count);
    }
}

/* Finds the number of diagonals below and above the main one, of the entries of front k and those that its children
 * add. */
void fu_find_width(const fu_fronts *t, fu_banded_front *b, int k)
{
    b->lower = b->upper = 0;
    for (int j = 0; j < t->pivots[k]; ++j)
        for (int e = b->first[j]; e < b->first[j + 1]; ++e) {
            const int below = b->place[b->rows[e]] - b->place[j];
            if (below > b->lower) b->lower = below;
            if (-below > b->upper) b->upper = -below;
        }
    for (int c = t->child[k]; c >= 0; c = t->sibling[c]) {
        const int *in_parent = t->in_parent + t->first[c] + t->pivots[c];
        int least = t->pivots[k], most = 0;
        for (int i = 0; i < t->neighbours[c]; ++i) {
            const int place = b->place[in_parent[i]];
            least = place < least ? place : least;
            most = place > most ? place : most;
        }
        if (most - least > b->lower) b->lower = most - least;
        if (most - least > b->upper) b->upper = most - least;
    }
}

/* Sets the matrix of a front to zero where it has entries, if these are known. */
int fu_clear_entries(fu_banded_front *b, int n, double *matrix)
{
    if (!b->is_listed) return 0;
    for (int j = 0; j < n; ++j)
        for (int e = b->first[j]; e < b->first[j + 1]; ++e) matrix[(long)j * n + b->rows[e]] = 0.0;
    b->is_listed = 0;
    return 1;
}
