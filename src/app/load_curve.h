/* load_curve.h - the curves that `mimdsim load` is asked for: made from machines, routings, levels
 * and traffic, measured by several threads, kept in the database point by point. */
#ifndef APP_LOAD_CURVE_H
#define APP_LOAD_CURVE_H

#include "app/load_options.h"
#include "store/store.h"
#include "study/load.h"

/* One curve with its points. What a thread needs of it is in `question`, which nothing writes once
 * the curve is made; its series and points are written under the lock of those who measure. */
struct load_curve {
    struct machine_spec machine;
    struct load_question question;
    struct load_recording recording; /* where the traffic is one */
    struct load_series series;
    int npoint;
    struct load_point *point; /* (npoint) one for each rate, in the order of the rates */
};

/* load_curves_make: every machine x routing x level x traffic of the command line, (*n) of them in
 * a, in this order; nothing is simulated. Unless a size was asked for, o->bytes rises where links
 * hold more messages than a run may have. Returns false with ERR_USAGE, ERR_NO_INPUT, ERR_DATA or
 * ERR_CONFIG for what cannot be run. */
bool load_curves_make(const struct common *c, struct load_options *o, struct load_curve **list,
                      int *n, struct arena *a, struct err *e);

/* load_curves_measure: all points and saturations that are not stored yet (all, with c->force), by
 * c->jobs threads (0: one for each processor), each point stored when it is known. Returns false
 * with the first error; what was stored by then stays. */
bool load_curves_measure(const struct common *c, const struct load_options *o,
                         struct load_curve *list, int n, struct store *s, struct err *e);

/* load_store_series, load_store_point: one row in place of an older one. load_add_series: the row
 * of a series unless there is one. load_find_point: whether the point is stored, and the point;
 * probe as in struct load_point. load_forget: the rows of a series go. All return false with *e as
 * store_insert. */
bool load_add_series(struct store *s, const struct load_series *x, struct err *e);
bool load_store_series(struct store *s, const struct load_series *x, struct err *e);
bool load_store_point(struct store *s, const struct load_series *x, const struct load_point *p,
                      struct err *e);
bool load_find_point(struct store *s, const struct load_series *x, double offered, bool probe,
                     bool *found, struct load_point *p, struct err *e);
bool load_forget(struct store *s, const struct load_series *x, struct err *e);

/* load_is_recording: whether a word of --traffic is DATABASE:RUN. load_recording_read: the messages
 * of that run into *x, memory from a; false with ERR_USAGE, ERR_NO_INPUT or ERR_DATA.
 * load_recording_identify: what they are, for a digest, appended. */
bool load_is_recording(const char *word);
bool load_recording_read(const char *word, struct load_recording *x, struct arena *a,
                         struct err *e);
void load_recording_identify(const struct load_recording *x, struct text *out);

/* load_print: every curve as a table. load_json: all of them as one document. */
void load_print(const struct load_curve *list, int n, FILE *out);
void load_json(const struct load_curve *list, int n, FILE *out);

#endif
