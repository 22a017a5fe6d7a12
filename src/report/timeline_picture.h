/* timeline_picture.h - the timeline of one run as a picture, for any number of ranks. */
#ifndef REPORT_TIMELINE_PICTURE_H
#define REPORT_TIMELINE_PICTURE_H

#include "measure/run_result.h"
#include "store/store.h"

struct timeline_view {
    const struct run_result *run; /* with its spans; with its path where that was looked for */
    int64_t run_id;               /* in the store, for the provenance */
    const char *title;            /* one line for people */
    int first_rank, last_rank;    /* both within the run */
    int64_t begin_ps, end_ps;     /* window, begin < end */
};

/* timeline_picture: draw it as AS.png and AS.svg into folder `dir`, as report_figure does. A row is
 * a rank, with all its spans and messages, as long as there is room; else a group of neighbouring
 * ranks, of which each piece of time shows what they do most. Below it, how many ranks do what at
 * each time; over it, the critical path.
 * Returns false as report_figure. */
bool timeline_picture(struct store *s, const char *data_dir, const struct timeline_view *v,
                      const char *as, const char *dir, struct err *e);

#endif
