/* task.c - see task.h.
 *
 * Everything that says how the task is simulated gets one value in all runs; then the identity of
 * such a run is that of its task, by the same rules as ever (identity.h): files count by their
 * content, settings by what differs from their defaults. */
#include "spec/task.h"

#include <string.h>

#include "spec/identity.h"
#include "spec/spec_fields.h"

struct run_spec task_of(const struct run_spec *run, struct arena *a)
{
    struct run_spec task = *run;
    memset(&task.machine, 0, sizeof task.machine);
    field_defaults(&machine_table, &task.machine, a);
    memset(task.scenario, 0, sizeof task.scenario);
    memset(task.label, 0, sizeof task.label);
    memset(&task.record, 0, sizeof task.record);
    task.seed = 0;
    task.rep = 0;
    /* How its computing is counted is the simulator's affair, too. */
    task.program.cost = PROGRAM_COST_DECLARED;
    task.program.factor = 1;
    run_identify(&task, a);
    return task;
}
