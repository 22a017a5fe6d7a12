/* omission.c - see omission.h.
 *
 * What this room leaves out is exact (bound 0): no simulated time and no result depends on it.
 * The bits of run_order.keep undo one at a time, which `explain --measure` uses to show that. */
#include "run/omission.h"

#include "run/launch.h"

/* Without a known largest message every send gets an event of its own. */
int64_t omission_largest_message(const struct program_run *r)
{
    return r->order.keep & KEEP_START_EVENTS ? -1 : launch_largest_message(r);
}

/* Undone, level auto simulates every route as level packet does. */
struct machine_spec omission_machine(const struct run_spec *spec, unsigned keep)
{
    struct machine_spec m = spec->machine;
    if ((keep & KEEP_CONTENTION) && m.network.level == LEVEL_AUTO) m.network.level = LEVEL_PACKET;
    return m;
}

/* Undone, everything is recorded whether or not it is asked for. */
struct record_spec omission_record(const struct run_spec *spec, unsigned keep)
{
    struct record_spec r = spec->record;
    if (keep & KEEP_SPANS) r.spans = true;
    if (keep & KEEP_LINKS) r.links = true;
    return r;
}

/* Sends need no event of their own where every message is eager: always, or because the largest
 * is. */
static void list_starts(const struct program_run *r, struct left_out *l)
{
    const enum network_level level = r->spec.machine.network.level;
    const int64_t eager = software_eager_most(&r->spec.machine.software);
    const int64_t largest = launch_largest_message(r);
    if (level != LEVEL_LINK && level != LEVEL_PACKET && level != LEVEL_AUTO) return;
    if (eager == INT64_MAX)
        leave_out_add(l, 0, 0, "events that start messages",
                      "the machine sends every message at once, in order");
    else if (largest >= 0 && largest <= eager)
        leave_out_add(l, KEEP_START_EVENTS, 0, "events that start messages",
                      "eager sends are in order");
}

/* What the program leaves out, then what this room does. Each is listed once, with the bit that
 * undoes it. */
int omission_listing(const struct program_run *r, struct omission *out)
{
    /* bound 0: exact */
    const struct run_spec *spec = &r->spec;
    struct left_out l = {r->order.keep, out, 0};
    if (r->type->leave_out) r->type->leave_out(r, &l);
    list_starts(r, &l);
    if (spec->machine.network.level == LEVEL_AUTO)
        leave_out_add(&l, KEEP_CONTENTION, 0, "contention where routes share no link",
                      "level auto has the packet level's times");
    if (!spec->record.spans)
        leave_out_add(&l, KEEP_SPANS, 0, "timeline", "record.spans does not ask for it");
    if (!spec->record.links)
        leave_out_add(&l, KEEP_LINKS, 0, "counters of single links",
                      "record.links does not ask for them");
    return l.n;
}
