/* compare_print.c - a comparison as text for people and as one JSON document; see compare.h. */
#include "report/compare.h"

#include <math.h>
#include <string.h>

#include "base/json.h"
#include "base/text.h"

enum { LONGEST_LIST = 40, LONGEST_CELL = 30 };

/* "1.302 ms" */
static void print_time(double s, char *buffer, size_t size)
{
    /* Three to four digits are what a comparison is read for. */
    const double us = s * 1e6;
    if (us >= 1e6) snprintf(buffer, size, "%.4g s", s);
    else if (us >= 1e3) snprintf(buffer, size, "%.4g ms", us / 1e3);
    else snprintf(buffer, size, "%.4g us", us);
}

/* "0.62 +- 0.01", or the ratio alone where both are single runs. */
static void print_ratio(const struct compare_point *p, int side, char *buffer, size_t size)
{
    double error;
    const double ratio = compare_ratio(p, side, &error);
    if (isnan(ratio)) text_copy(buffer, size, "-");
    else if (error > 0) snprintf(buffer, size, "%.3g +- %.1g", ratio, ratio * error);
    else snprintf(buffer, size, "%.4g", ratio);
}

/* The sides with their letters, which the tables use. */
static void print_sides(const struct compare *c, FILE *out)
{
    for (int i = 0; i < c->nside; i++)
        fprintf(out, "%c  %s: %d run%s%s\n", 'A' + i, c->side[i].name, c->side[i].nrun,
                c->side[i].nrun == 1 ? "" : "s", c->side[i].machines ? " on several machines" : "");
}

/* First the answer: how the times compare, over all common points. */
static void print_summary(const struct compare *c, FILE *out)
{
    /* Against the first side, which whoever calls it has put first. */
    fprintf(out, "\n");
    for (int s = 1; s < c->nside; s++) {
        /* Ratios multiply, so that their mean is the geometric one. */
        double sum = 0, least = INFINITY, most = 0, error;
        for (int i = 0; i < c->ncommon; i++) {
            const double ratio = compare_ratio(&c->point[i], s, &error);
            sum += log(ratio);
            least = fmin(least, ratio);
            most = fmax(most, ratio);
        }
        fprintf(out, "%c takes %.4g times as long as A", 'A' + s, exp(sum / c->ncommon));
        if (c->ncommon > 1)
            fprintf(out, " (geometric mean of %d points, %.4g to %.4g)", c->ncommon, least, most);
        fprintf(out, ".\n");
    }
}

/* What was asked of the sides: the cause of all that follows. */
static void print_differences(const struct compare *c, FILE *out)
{
    if (c->ndifference == 0) {
        fprintf(out, "\nNo setting that all runs of a side share differs between the sides.\n");
        return;
    }
    fprintf(out, "\nSettings that differ:\n%-36s", "");
    for (int s = 0; s < c->nside; s++) fprintf(out, " %-*c", LONGEST_CELL, 'A' + s);
    fprintf(out, "\n");
    for (int i = 0; i < c->ndifference; i++) {
        const struct compare_difference *d = &c->difference[i];
        fprintf(out, "%-36s", d->key);
        /* A long value is cut: `mimdsim machines --compare` and the database have all of it. */
        for (int s = 0; s < c->nside; s++)
            fprintf(out, " %-*.*s", LONGEST_CELL, LONGEST_CELL, d->value[s]);
        fprintf(out, "\n");
    }
}

/* Points are named by their settings, so that columns are as wide as these. */
static int widest_name(const struct compare *c)
{
    size_t n = 5;
    /* Also of points that are left out: the width must not depend on which these are. */
    for (int i = 0; i < c->npoint; i++)
        if (strlen(c->point[i].name) > n) n = strlen(c->point[i].name);
    return (int)n;
}

/* A row a point: the times of the sides, and their ratios to the first. */
static void print_results(const struct compare *c, FILE *out)
{
    /* The first column is as wide as the longest name of a point. */
    const int wide = widest_name(c);
    char cell[48];
    bool spread = false;
    fprintf(out, "\nTimes:\n%-*s", wide, "point");
    /* Times first, then what they are over those of A. */
    for (int s = 0; s < c->nside; s++) fprintf(out, " %12c", 'A' + s);
    for (int s = 1; s < c->nside; s++) fprintf(out, " %14c/A", 'A' + s);
    fprintf(out, "\n");
    for (int i = 0; i < c->ncommon && i < LONGEST_LIST; i++) {
        const struct compare_point *p = &c->point[i];
        fprintf(out, "%-*s", wide, p->name);
        for (int s = 0; s < c->nside; s++) {
            print_time(p->cell[s].makespan, cell, sizeof cell);
            fprintf(out, " %12s", cell);
            spread = spread || p->cell[s].half > 0;
        }
        for (int s = 1; s < c->nside; s++) {
            print_ratio(p, s, cell, sizeof cell);
            fprintf(out, " %16s", cell);
        }
        fprintf(out, "\n");
    }
    if (c->ncommon > LONGEST_LIST)
        fprintf(out, "and %d point%s more: --json has all\n", c->ncommon - LONGEST_LIST,
                c->ncommon - LONGEST_LIST == 1 ? "" : "s");
    fprintf(out,
            spread
                ? "+-: half of the 95 %% confidence interval, from repetitions\n"
                : "Single runs: simulated times have no spread; how far the model is off, `mimdsim "
                  "accuracy` and `validate` tell.\n");
    if (c->npoint > c->ncommon)
        fprintf(out, "Left out: %d point%s that not all sides have.\n", c->npoint - c->ncommon,
                c->npoint - c->ncommon == 1 ? "" : "s");
}

/* At the largest common point, which is the last one. */
static void print_parts(const struct compare *c, FILE *out)
{
    /* One point is enough to see the reason; the figure has all of them. */
    const struct compare_point *p = &c->point[c->ncommon - 1];
    char cell[48];
    fprintf(out, "\nWhere the time goes%s%s (mean over the ranks):\n%-24s",
            p->name[0] != '\0' ? " at " : "", p->name, "");
    for (int s = 0; s < c->nside; s++) fprintf(out, " %20c", 'A' + s);
    fprintf(out, "\n");
    for (int k = 0; k < COMPARE_PARTS; k++) {
        fprintf(out, "%-24s", compare_part[k]);
        for (int s = 0; s < c->nside; s++) {
            /* The time, and its share of this side's own run. */
            char shown[64];
            const struct compare_cell *a = &p->cell[s];
            print_time(a->part[k], cell, sizeof cell);
            snprintf(shown, sizeof shown, "%s (%.0f %%)", cell,
                     a->makespan > 0 ? 100 * a->part[k] / a->makespan : 0);
            fprintf(out, " %20s", shown);
        }
        fprintf(out, "\n");
    }
}

/* ---- JSON ---- */

/* In the order of the sides. */
static void json_values(struct json *j, const struct compare *c, const struct compare_difference *d)
{
    json_key(j, "values");
    json_array(j);
    for (int s = 0; s < c->nside; s++) json_text(j, d->value[s]);
    json_end(j);
}

/* A point that a side lacks has no runs, and its numbers are null. */
static void json_cell(struct json *j, const struct compare_point *p, int side)
{
    const struct compare_cell *cell = &p->cell[side];
    double error;
    const double ratio = compare_ratio(p, side, &error);
    json_object(j);
    json_key_real(j, "compute_s", cell->part[0]);
    json_key_real(j, "contention_s", cell->part[3]);
    json_key_real(j, "half_width_s", cell->half);
    json_key_real(j, "makespan_s", cell->runs > 0 ? cell->makespan : NAN);
    json_key_real(j, "overhead_s", cell->part[1]);
    json_key_real(j, "ratio", ratio);
    json_key_real(j, "ratio_error", isnan(ratio) ? NAN : error * ratio);
    json_key_int(j, "runs", cell->runs);
    json_key_real(j, "wait_s", cell->part[2]);
    json_end(j);
}

/* Everything, also the points that not all sides have. */
static void print_json(const struct compare *c, FILE *out)
{
    struct json j = json_make(out);
    json_object(&j);
    json_key(&j, "differences");
    json_array(&j);
    for (int i = 0; i < c->ndifference; i++) {
        json_object(&j);
        json_key_text(&j, "key", c->difference[i].key);
        json_values(&j, c, &c->difference[i]);
        json_end(&j);
    }
    json_end(&j);
    /* Points in the order of the table. */
    json_key(&j, "points");
    json_array(&j);
    for (int i = 0; i < c->npoint; i++) {
        json_object(&j);
        json_key_text(&j, "point", c->point[i].name);
        json_key(&j, "sides");
        json_array(&j);
        for (int s = 0; s < c->nside; s++) json_cell(&j, &c->point[i], s);
        json_end(&j);
        json_end(&j);
    }
    json_end(&j);
    /* Names last: keys stand in the order of the alphabet. */
    json_key(&j, "sides");
    json_array(&j);
    for (int s = 0; s < c->nside; s++) json_text(&j, c->side[s].name);
    json_end(&j);
    json_end(&j);
    json_finish(&j);
}

/* The answer comes before its reasons. */
void compare_print(const struct compare *c, bool json, FILE *out)
{
    if (json) {
        print_json(c, out);
        return;
    }
    print_sides(c, out);
    print_summary(c, out);
    print_differences(c, out);
    print_results(c, out);
    print_parts(c, out);
}
