/* run_columns.c - the columns of every struct of run_result.h: a new result is a member there and a
 * row here.
 *
 * Names are those of the database and end in their unit; what may be absent is COLUMN_NULL, with
 * the condition or the number that says so. */
#include "measure/run_row.h"

/* A member of the run's result, and one of the row itself. */
#define RESULT(member)                                                                             \
    .part = PART(struct run_row, result), .offset = offsetof(struct run_result, member)
#define ROW(member) .offset = offsetof(struct run_row, member)

/* In the order of the enum, as all lists of words here. */
static const char *const status_word[] = {"ok", "invalid", "deadlock", "failed"};

/* Conditions: where a column's number would mean nothing. */
static const struct run_result *result_of(const void *row)
{
    return ((const struct run_row *)row)->result;
}

/* No loops: rank and drift mean nothing. */
static bool has_loops(const void *row) { return result_of(row)->loop_rows > 0; }

/* Without refinement there is no residual before it. */
static bool is_refined(const void *row) { return run_result_refined(result_of(row)); }

static bool has_stages(const void *row) { return ((const struct run_row *)row)->ranks.has_stages; }

static bool has_finish(const void *row) { return ((const struct run_row *)row)->ranks.has_finish; }

/* What came out of a run, apart from its times by stage. */
static const struct column run_outcome[] = {
    /* How it ended, and when by the simulated clock. */
    {"status", COLUMN_WORD, RESULT(status), WORDS(status_word), .doc = "how it ended"},
    {"text", COLUMN_CHARS, RESULT(text), .doc = "why it is not ok"},
    {"makespan_ps", COLUMN_INT64, RESULT(makespan_ps),
     .doc = "when the last rank ended, simulated time; of a deadlock, when the last stood still"},
    {"measured_s", COLUMN_REAL, RESULT(measured_s), .flags = COLUMN_NULL,
     .doc = "what a micro-benchmark's kernel measured, simulated time"},
    /* Closed chains (physics 7): constraints, how many are independent, how far they have
     * drifted. */
    {"loop_rows", COLUMN_INT, RESULT(loop_rows), .flags = COLUMN_NULL, .absent = ABSENT_ZERO,
     .doc = "constraints of closed chains; NULL: no loops"},
    {"loop_rank", COLUMN_INT, RESULT(loop_rank), .flags = COLUMN_NULL, .absent = ABSENT_NEGATIVE,
     .known = has_loops,
     .doc = "independent ones among them: fewer than loop_rows are redundant"},
    {"drift_position", COLUMN_REAL, RESULT(drift_position), .flags = COLUMN_NULL,
     .known = has_loops,
     .doc = "largest violation of a loop when the run ends, in the model's units"},
    {"drift_velocity", COLUMN_REAL, RESULT(drift_velocity), .flags = COLUMN_NULL,
     .known = has_loops,
     .doc = "largest velocity of such a violation, in the model's units"},
    /* What the solver saw (physics 4.8, 8): whether the answer can be trusted. */
    {"residual", COLUMN_REAL, RESULT(residual), .flags = COLUMN_NULL,
     .doc = "largest relative residual of the constraints, as the kernel sees it"},
    {"condition", COLUMN_REAL, RESULT(condition), .flags = COLUMN_NULL, .absent = ABSENT_ZERO,
     .doc = "lower bound of the condition of the block-scaled system"},
    /* Counts of the whole run, and the fingerprint that must be the same on every host. */
    {"messages", COLUMN_INT64, RESULT(messages), .doc = "sent by all ranks"},
    {"sent_bytes", COLUMN_INT64, RESULT(bytes), .doc = "in them"},
    {"events", COLUMN_INT64, RESULT(events), .doc = "dispatched by the simulator"},
    {"ties", COLUMN_INT64, RESULT(ties),
     .doc = "events that shared their time with the one before"},
    {"switches", COLUMN_INT64, RESULT(switches), .doc = "from one rank's program to another's"},
    {"digest", COLUMN_HEX, RESULT(digest),
     .doc = "of all messages and clocks: 16 hexadecimal digits"},
    /* Of ranks: do the accounts add up, and how even is the load. */
    {"accounting_error_ps", COLUMN_INT64, ROW(ranks.accounting_error),
     .doc = "largest |sum of all parts - makespan| over the ranks; 0 is exact"},
    {"finish_min_ps", COLUMN_INT64, ROW(ranks.finish_min), .flags = COLUMN_NULL,
     .known = has_finish,
     .doc = "when the first rank ended"},
    {"finish_max_ps", COLUMN_INT64, ROW(ranks.finish_max), .flags = COLUMN_NULL,
     .known = has_finish,
     .doc = "when the last rank ended"},
    {"rank_compute_min_ps", COLUMN_INT64, ROW(ranks.compute_min), .flags = COLUMN_NULL,
     .known = has_stages,
     .doc = "computing of the least loaded rank"},
    {"rank_compute_max_ps", COLUMN_INT64, ROW(ranks.compute_max), .flags = COLUMN_NULL,
     .known = has_stages,
     .doc = "computing of the most loaded rank"},
    {"links", COLUMN_INT, RESULT(nlink), .doc = "link loads that were recorded, stored or not"},
    /* What the simulation took on this computer: never the same twice, no part of any result. */
    {"host_s", COLUMN_REAL, RESULT(host_s), .flags = COLUMN_NULL,
     .doc = "wall time of the simulation proper"},
    {"host_total_s", COLUMN_REAL, RESULT(host_total_s), .flags = COLUMN_NULL,
     .doc = "wall time with model, references and checks"},
    {"host_peak_bytes", COLUMN_INT64, RESULT(host_peak_bytes), .flags = COLUMN_NULL,
     .doc = "most memory that the run used on this computer"},
    {"stack_peak_bytes", COLUMN_INT64, RESULT(stack_peak_bytes), .flags = COLUMN_NULL,
     .doc = "deepest stack of a rank"},
};
const struct column_table run_outcome_columns = COLUMNS(run_outcome);

/* What the program did on its own account to get an answer that can be trusted. */
static const struct column run_refinement[] = {
    {"inner_added", COLUMN_INT, RESULT(inner_added),
     .doc = "refinements inside a solution that were switched on because the first answer needed "
            "them"},
    {"outer_added", COLUMN_INT, RESULT(outer_added),
     .doc = "refinements of whole solutions, likewise"},
    {"twice_added", COLUMN_BOOL, RESULT(twice_added),
     .doc = "1: the residual in twice the digits was switched on, too"},
    {"residual_before", COLUMN_REAL, RESULT(residual_before), .flags = COLUMN_NULL,
     .known = is_refined,
     .doc = "of that first answer; `residual` and all times are those with the refinements"},
    {"left_out", COLUMN_STRING, ROW(left_out.s),
     .doc = "what it left out, with reasons: run_omission as text"},
};
const struct column_table run_refinement_columns = COLUMNS(run_refinement);

/* --- stages ----------------------------------------------------------------------------------- */

/* Sums over ranks can pass 64 bits where each rank's time does not. */
static void read_sum(const struct column *c, const void *row, struct column_value *v)
{
    const struct spread *p = (const void *)((const char *)row + c->offset);
    if (!p->fits) return;
    v->kind = VALUE_INT;
    v->integer = p->sum;
}

/* Sum, least and most of one part of a stage's time: three columns. */
#define SPREAD(name, text)                                                                         \
    {#name "_sum_ps", COLUMN_INT64, .offset = offsetof(struct stage_row, name),                    \
     .flags = COLUMN_NULL, .value = read_sum,                                                      \
     .doc = text ", of all ranks; NULL: does not fit into 64 bits"},                               \
    {#name "_min_ps", COLUMN_INT64, .offset = offsetof(struct stage_row, name.min),                \
     .doc = text ", least rank"},                                                                  \
    {#name "_max_ps", COLUMN_INT64, .offset = offsetof(struct stage_row, name.max),                \
     .doc = text ", most loaded rank"}

/* The classes of work of the member `work` of `row`, one column each (base/work.h): a node's cost
 * distinguishes them, so that times can be predicted again for another node. */
#define WORK(row, work)                                                                            \
    {"flops", COLUMN_COUNT, .offset = offsetof(row, work.flop),                                    \
     .doc = "additions, subtractions and multiplications"},                                        \
    {"divisions", COLUMN_COUNT, .offset = offsetof(row, work.div),                                 \
     .doc = "floating-point divisions"},                                                           \
    {"square_roots", COLUMN_COUNT, .offset = offsetof(row, work.sqrt), .doc = "square roots"},     \
    {"sines", COLUMN_COUNT, .offset = offsetof(row, work.trig),                                    \
     .doc = "sines and cosines, one each"},                                                        \
    {"copied_bytes", COLUMN_COUNT, .offset = offsetof(row, work.bytes),                            \
     .doc = "copied from memory to memory"},                                                       \
    {"calls", COLUMN_COUNT, .offset = offsetof(row, work.call),                                    \
     .doc = "calls of small dense operators"}

/* One stage over all ranks: sum and extremes of each part of its time. */
static const struct column stage_row[] = {
    {"name", COLUMN_STRING, .offset = offsetof(struct stage_row, name),
     .doc = "as the program calls it"},
    SPREAD(compute, "computing"),
    SPREAD(send, "send overhead, copies, back-pressure of the sender's software"),
    SPREAD(recv, "receive overhead and copies"),
    /* Waiting in two parts: what an empty network would have caused as well, and what others
     * caused. */
    SPREAD(wait,
           "waiting that an uncontended network would also have caused, and idling at the end"),
    SPREAD(contention, "further waiting for links, ports and servers shared with other messages"),
    SPREAD(total, "all of these"),
    {"messages", COLUMN_INT64, .offset = offsetof(struct stage_row, all.messages),
     .doc = "sent by all ranks"},
    {"sent_bytes", COLUMN_INT64, .offset = offsetof(struct stage_row, all.bytes), .doc = "in them"},
    WORK(struct stage_row, all.work),
};
const struct column_table stage_row_columns = COLUMNS(stage_row);

#define STAGE(name, member, text)                                                                  \
    {                                                                                              \
        name, COLUMN_INT64, .offset = offsetof(struct stage_time, member), .doc = text             \
    }

/* One stage of one rank. All its parts together, over all stages, are the makespan. */
static const struct column stage_time[] = {
    STAGE("compute_ps", compute_ps, "computing"),
    STAGE("send_ps", send_ps, "send overhead, copies, back-pressure of the sender's software"),
    STAGE("recv_ps", recv_ps, "receive overhead and copies"),
    /* The same two parts of waiting as above. */
    STAGE("wait_ps", wait_ps,
          "waiting that an uncontended network would also have caused, and idling at the end"),
    STAGE("contention_ps", contention_ps,
          "further waiting for links, ports and servers shared with other messages"),
    STAGE("messages", messages, "sent"),
    STAGE("sent_bytes", bytes, "in them"),
    {"flops", COLUMN_COUNT, .offset = offsetof(struct stage_time, work.flop),
     .doc = "additions, subtractions and multiplications"},
};
const struct column_table stage_time_columns = COLUMNS(stage_time);

/* --- what the speedup is measured against, checks, omissions ---------------------------------- */

/* Serial codes and their predicted times. */
static const struct column baseline[] = {
    {"name", COLUMN_CHARS, .offset = offsetof(struct baseline, name), .doc = "of the serial code"},
    {"time_ps", COLUMN_INT64, .offset = offsetof(struct baseline, time_ps),
     .doc = "predicted, on one processor"},
    WORK(struct baseline, work),
};
const struct column_table baseline_columns = COLUMNS(baseline);

static void read_passed(const struct column *c, const void *row, struct column_value *v)
{
    const struct error_check *check = row;
    (void)c;
    v->kind = VALUE_BOOL;
    v->integer = check->relative <= check->tolerance; /* a NaN has not passed */
}

/* Every comparison with a reference, also those that were passed. */
static const struct column error_check[] = {
    {"quantity", COLUMN_CHARS, .offset = offsetof(struct error_check, quantity),
     .doc = "what was compared: tau, qdd"},
    {"reference", COLUMN_CHARS, .offset = offsetof(struct error_check, reference),
     .doc = "with which algorithm's"},
    {"relative_error", COLUMN_REAL, .offset = offsetof(struct error_check, relative),
     .flags = COLUMN_NULL,
     .doc = "largest difference over the largest reference; NULL: not finite"},
    /* Kept with the error: tolerances may change with a version. */
    {"tolerance", COLUMN_REAL, .offset = offsetof(struct error_check, tolerance),
     .flags = COLUMN_NULL,
     .doc = "above it the run is invalid"},
    {"passed", COLUMN_BOOL, .value = read_passed, .doc = "1: within the tolerance"},
};
const struct column_table error_check_columns = COLUMNS(error_check);

static const char *const class_word[] = {"exact", "bounded"};

/* A bound of 0 means exact: the same numbers. */
const char *omission_class(const struct omission *o) { return class_word[o->bound > 0]; }

/* The class follows from the bound and is not stored twice. */
static void read_class(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    v->kind = VALUE_TEXT;
    v->text = omission_class(row);
}

/* What was left out, and what that may change. */
static const struct column omission[] = {
    {"what", COLUMN_CHARS, .offset = offsetof(struct omission, what), .doc = "was not computed"},
    {"why", COLUMN_CHARS, .offset = offsetof(struct omission, why),
     .doc = "why no result needs it"},
    {"class", COLUMN_WORD, .value = read_class, WORDS(class_word),
     .doc = "exact: the results are the same numbers; bounded: to within `bound`"},
    {"bound", COLUMN_REAL, .offset = offsetof(struct omission, bound), .flags = COLUMN_NULL,
     .absent = ABSENT_ZERO,
     .doc = "largest relative change of a result, of bounded ones"},
};
const struct column_table omission_columns = COLUMNS(omission);

/* --- links and timelines ---------------------------------------------------------------------- */

/* Ports have a node, links have routers: the other columns are NULL. */
#define LINK(name, kind, member, ...)                                                              \
    {                                                                                              \
        name, kind, .offset = offsetof(struct link_load, member), __VA_ARGS__                      \
    }
#define UNLESS_NEGATIVE .flags = COLUMN_NULL, .absent = ABSENT_NEGATIVE

/* One line for each resource of the network: ports of nodes, and links. */
static const struct column link_load[] = {
    LINK("from_router", COLUMN_INT, from, UNLESS_NEGATIVE, .doc = "NULL: injection of `node`"),
    LINK("to_router", COLUMN_INT, to, UNLESS_NEGATIVE, .doc = "NULL: ejection to `node`"),
    LINK("node", COLUMN_INT, node, UNLESS_NEGATIVE,
         .doc = "of an injection or ejection; NULL: between routers"),
    LINK("messages", COLUMN_INT64, messages, .doc = "that went over it"),
    LINK("sent_bytes", COLUMN_INT64, bytes, .doc = "in them"),
    LINK("busy_ps", COLUMN_INT64, busy_ps, .doc = "time in use"),
    LINK("queue_ps", COLUMN_INT64, queue_ps,
         .doc = "sum over the messages of the time spent waiting for it"),
};
const struct column_table link_load_columns = COLUMNS(link_load);

static const char *const span_word[] = {"compute", "send", "recv", "wait", "barrier"};

#define SPAN(name, kind, member, ...)                                                              \
    {                                                                                              \
        name, kind, .offset = offsetof(struct span, member), __VA_ARGS__                           \
    }

/* The timeline: who did what from when to when. */
static const struct column span[] = {
    SPAN("rank", COLUMN_INT, rank, .doc = "whose timeline"),
    SPAN("stage", COLUMN_INT, stage, .doc = "number of the stage"),
    SPAN("kind", COLUMN_WORD, kind, WORDS(span_word), .doc = "what the rank did"),
    SPAN("begin_ps", COLUMN_INT64, begin_ps, .doc = "simulated time"),
    SPAN("end_ps", COLUMN_INT64, end_ps, .doc = "simulated time"),
    SPAN("peer", COLUMN_INT, peer, UNLESS_NEGATIVE, .doc = "the other rank; NULL: none"),
    SPAN("bytes", COLUMN_INT64, bytes, .doc = "of the message"),
    /* A send and its receive have one number, so that a viewer can draw the arrow. */
    SPAN("message", COLUMN_INT64, message, UNLESS_NEGATIVE,
         .doc = "pairs a send with its receive; NULL: none"),
};
const struct column_table span_columns = COLUMNS(span);
