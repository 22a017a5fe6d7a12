/* machine_changes.h - how the machine of a run differs from the one that is shipped under its name.
 *
 * What a study claims of a machine holds for the machine as its file describes it. A run with other
 * settings, by --set or by a file of one's own with the same name, is a what-if; this is how it is
 * told. */
#ifndef PLAN_MACHINE_CHANGES_H
#define PLAN_MACHINE_CHANGES_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/text.h"
#include "spec/run_spec.h"

/* What is remembered from run to run; begins as zeros with the arena. */
struct machine_changes {
    struct arena *arena;
    struct shipped_machine *known; /* read so far */
    bool any;
    struct machine_spec last; /* of the run before, and what was found of it */
    const char *text, *hash;
};

/* machine_changes_note: fill run->machine_changes and run->machine_hash; texts live in c->arena.
 *
 * The level of the network and its tolerance are questions, not properties of a machine, and are
 * left out. A shipped file that cannot be read counts as none. */
void machine_changes_note(struct machine_changes *c, struct run_spec *run);

/* machine_changes_read: the file `path` was read, and describes `spec`: where it is the shipped
 * one, it is not read again for the comparison. */
void machine_changes_read(struct machine_changes *c, const char *path,
                          const struct machine_spec *spec);

/* machine_changes_between: what `own` has otherwise than `from`, as such a JSON object, appended to
 * *out. */
void machine_changes_between(const struct machine_spec *from, const struct machine_spec *own,
                             struct text *out);

#endif
