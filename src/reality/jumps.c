/* jumps.c - see jumps.h. Pieces by dynamic programming (Bellman, "On the approximation of curves by
 * line segments using dynamic programming", 1961), whose measure is the largest relative residual
 * of a piece, since that is what a prediction of one message is off by. */
#include "reality/jumps.h"

#include <math.h>

#include "reality/fit.h"

/* Residuals up to NOISE are not told from measuring; lines that are CLEAR apart are two. */
#define NOISE 0.05
#define CLEAR 0.1

/* Two sizes this near to each other are where a jump is (1 part in NEAR). */
enum { NEAR = 8 };

/* The line through points first .. end - 1. */
static struct fit_line line_of(const struct messages *m, int first, int end)
{
    double bytes[MESSAGES_SIZES], one_way[MESSAGES_SIZES];
    for (int i = first; i < end; i++) {
        bytes[i - first] = (double)m->point[i].bytes;
        one_way[i - first] = m->point[i].one_way;
    }
    return fit_line_of(bytes, one_way, end - first);
}

/* How far off the worst of these points is; a hand-shake and none are never one piece. */
static double residual_of(const struct messages *m, int first, int end)
{
    if (m->point[first].rendezvous != m->point[end - 1].rendezvous) return INFINITY;
    return line_of(m, first, end).residual;
}

int jumps_find(const struct messages *m, int first[SOFTWARE_MAX_SEGMENTS])
{
    /* worst[k][j]: of the best k + 1 pieces for the first j points; from[k][j]: where the last of
     * them begins. */
    double worst[SOFTWARE_MAX_SEGMENTS][MESSAGES_SIZES + 1] = {{0}};
    int from[SOFTWARE_MAX_SEGMENTS][MESSAGES_SIZES + 1], pieces = 1;
    for (int j = 1; j <= m->n; j++) {
        worst[0][j] = residual_of(m, 0, j);
        from[0][j] = 0;
    }
    while (worst[pieces - 1][m->n] > NOISE && pieces < SOFTWARE_MAX_SEGMENTS && pieces < m->n) {
        const int k = pieces++;
        for (int j = 1; j <= m->n; j++) {
            worst[k][j] = worst[k - 1][j];
            from[k][j] = -1; /* as with one piece less */
            for (int i = 1; i < j; i++) {
                const double last = residual_of(m, i, j),
                             all = last > worst[k - 1][i] ? last : worst[k - 1][i];
                if (all >= worst[k][j]) continue;
                worst[k][j] = all;
                from[k][j] = i;
            }
        }
    }
    /* Back from the last piece to the first. */
    int n = 0, begin[SOFTWARE_MAX_SEGMENTS];
    for (int k = pieces - 1, j = m->n; j > 0; k--) {
        while (k > 0 && from[k][j] < 0) k--;
        begin[n++] = j = from[k][j];
    }
    for (int i = 0; i < n; i++) first[i] = begin[n - 1 - i];
    return n;
}

/* The piece that point `i` belongs to. */
static struct fit_line piece_of(const struct messages *m, int i)
{
    int first[SOFTWARE_MAX_SEGMENTS], n = jumps_find(m, first), k = n - 1;
    while (first[k] > i) k--;
    return line_of(m, first[k], k + 1 < n ? first[k + 1] : m->n);
}

double jumps_height(const struct messages *m, int i)
{
    const struct fit_line below = piece_of(m, i - 1), above = piece_of(m, i);
    const double b = (double)m->point[i].bytes, before = below.at_zero + below.slope * b;
    return before > 0 ? (above.at_zero + above.slope * b) / before - 1 : 0;
}

int64_t jumps_open(const struct messages *m)
{
    int first[SOFTWARE_MAX_SEGMENTS];
    const int n = jumps_find(m, first);
    for (int k = 1; k < n; k++) {
        const struct message_point *low = &m->point[first[k] - 1], *high = &m->point[first[k]];
        /* The switch to rendezvous is known to the byte. */
        if (low->rendezvous != high->rendezvous) continue;
        if (high->bytes - low->bytes <= high->bytes / NEAR + 1) continue;
        if (fabs(jumps_height(m, first[k])) >= CLEAR)
            return low->bytes + (high->bytes - low->bytes) / 2;
    }
    return -1;
}
