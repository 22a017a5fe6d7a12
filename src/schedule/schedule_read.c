/* schedule_read.c - a schedule from its file, whichever form it has. */
#include "base/text.h"
#include "schedule/schedule.h"

struct schedule *schedule_read(const char *path, struct arena *a, struct err *e)
{
    /* The first bytes decide and not the name: binary schedules are called .goal, too.
     * Readers copy what they keep, so the file's text ends here. */
    struct text file = {0};
    struct schedule *s = NULL;
    if (text_read_file(&file, path, e)) {
        const char *data = file.s ? file.s : "";
        s = goal_is_binary(data, file.length) ? goal_read_binary(data, file.length, path, a, e)
                                              : goal_read_text(data, file.length, path, a, e);
    }
    text_free(&file);
    return s;
}
