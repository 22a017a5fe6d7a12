/* load_print.c - curves for people and for programs (load_curve.h). */
#include <math.h>

#include "app/load_curve.h"
#include "base/json.h"

/* Above the table: what the curve is, and what is known before anything runs. */
static void print_head(const struct load_series *s, FILE *out)
{
    fprintf(out, "%s, routing %s, level %s, traffic %s\n", s->machine, s->routing, s->level,
            s->traffic);
    fprintf(out, "%d nodes, messages of %.4g flits, cycle %.5g ns, empty network %.5g ns", s->nodes,
            s->flits, s->cycle_ps * 1e-3, s->empty_ps * 1e-3);
    if (isfinite(s->bound)) fprintf(out, ", bound of the routes %.4f", s->bound);
    if (s->note[0]) fprintf(out, ", %s", s->note);
    fputc('\n', out);
}

/* The saturation with its uncertainty, in one line. */
static void print_saturation(const struct load_series *s, FILE *out)
{
    /* it was not looked for */
    if (s->probes == 0) return;
    if (isfinite(s->saturation))
        fprintf(out, "saturation at %.4g (held at %.4g, not at %.4g; %d loads tried)\n",
                s->saturation, s->low, s->high, s->probes);
    else if (s->low >= 1)
        fprintf(out, "no saturation up to load 1 (%d loads tried)\n", s->probes);
    else {
        /* Nothing above `low` could be told, and of 0 there is nothing to say. */
        fprintf(out, "saturation not found: at load 1 the mean latency is not known well enough (");
        if (s->low > 0) fprintf(out, "held at %.4g; ", s->low);
        fprintf(out, "%d loads tried); more --messages may tell\n", s->probes);
    }
}

/* As tables of columns: what the database has is what people read. */
void load_print(const struct load_curve *list, int n, FILE *out)
{
    for (int i = 0; i < n; i++) {
        if (i > 0) fputc('\n', out);
        /* each table can be read without the others */
        print_head(&list[i].series, out);
        columns_title(&load_point_columns, out);
        for (int k = 0; k < list[i].npoint; k++)
            columns_print(&load_point_columns, &list[i].point[k], out);
        print_saturation(&list[i].series, out);
    }
}

/* Keys in the order of the alphabet. */
void load_json(const struct load_curve *list, int n, FILE *out)
{
    struct json j = json_make(out);
    /* a list, also of one curve: scripts need one form */
    json_array(&j);
    for (int i = 0; i < n; i++) {
        json_object(&j);
        json_key(&j, "points");
        columns_json_list(&load_point_columns, list[i].point, list[i].npoint, sizeof *list[i].point,
                          &j);
        json_key(&j, "series");
        columns_json(&load_series_columns, &list[i].series, &j);
        json_end(&j);
    }
    json_end(&j);
    json_finish(&j);
}
