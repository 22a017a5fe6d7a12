/* real_columns.c - the columns of real_row.h, and statistics of repetitions. */
#include <math.h>

#include "base/check.h"
#include "base/sorted.h"
#include "base/text.h"
#include "measure/real_row.h"

/* --- statistics ------------------------------------------------------------------------------- */

/* The sorted values stay the caller's. */
struct real_times real_times_of(double *value, int n)
{
    CHECK(n >= 1);
    sort_numbers(value, (size_t)n);
    return (struct real_times){value[0], sorted_quantile(value, n, 0.25),
                               sorted_quantile(value, n, 0.5), sorted_quantile(value, n, 0.75),
                               value[n - 1]};
}

/* --- speed ------------------------------------------------------------------------------------ */

const char *host_operation_name(enum host_operation o)
{
    static const char *const name[HOST_OPERATIONS] = {"multiply_add", "call", "chain", "copy",
                                                      "message"};
    return name[o];
}

/* Four digits of each: a tenth of a per mille of what is compared by per cents. */
void real_bursts_text(const struct real_result *r, char *text, size_t size)
{
    struct text t = {0};
    text[0] = '\0';
    if (r->nburst == 0) return;
    text_add(&t, "{\"bursts\":[");
    for (int i = 0; i < r->nburst; i++) text_add(&t, "%s%d", i > 0 ? "," : "", r->burst[i].n);
    text_add(&t, "]");
    for (int o = 0; o < HOST_OPERATIONS; o++) {
        /* Of one rank there are no messages. */
        if (r->burst[0].before.time[o] <= 0) continue;
        text_add(&t, ",\"%s\":[", host_operation_name((enum host_operation)o));
        for (int i = 0; i < r->nburst; i++)
            text_add(&t, "%s%.4g,%.4g", i > 0 ? "," : "", r->burst[i].before.time[o] * 1e9,
                     r->burst[i].after.time[o] * 1e9);
        text_add(&t, "]");
    }
    text_add(&t, "}");
    CHECK(t.length < size);
    text_copy(text, size, t.s);
    text_free(&t);
}

/* --- columns ---------------------------------------------------------------------------------- */

/* Where a member of a real run lies. */
#define REAL(member) .offset = offsetof(struct real_result, member)

/* In the order of enum run_status. */
static const char *const status_word[] = {"ok", "invalid", "deadlock", "failed"};

/* Where nothing was timed there are no times. */
static bool has_samples(const void *row) { return ((const struct real_result *)row)->nsample > 0; }

/* A row of table real_run, behind what was run. */
static const struct column real_column[] = {
    /* Where, and with what. */
    {"backend", COLUMN_CHARS, REAL(backend),
     .doc = "mpi: this program's own ranks; record: an MPI program of its own"},
    {"mpi", COLUMN_CHARS, REAL(library), .doc = "which MPI"},
    {"host", COLUMN_CHARS, REAL(host), .doc = "name of the (first) computer"},
    {"processor", COLUMN_CHARS, REAL(processor), .doc = "what its processor is called"},
    {"placement", COLUMN_CHARS, REAL(placement), .doc = "which processors the ranks were on"},
    {"P", COLUMN_INT, REAL(nrank), .doc = "ranks"},
    {"processors", COLUMN_INT, REAL(processors), .doc = "that the job could use on that computer"},
    {"oversubscribed", COLUMN_BOOL, REAL(oversubscribed),
     .doc = "1: more ranks on a computer than processors"},
    /* How it ended, and how long it took. */
    {"status", COLUMN_WORD, REAL(status), WORDS(status_word), .doc = "how it ended"},
    {"text", COLUMN_CHARS, REAL(text),
     .doc = "why it is not ok; else how fast the computer was [ns], JSON"},
    {"samples", COLUMN_INT, REAL(nsample), .doc = "repetitions"},
    {"disturbed", COLUMN_INT, REAL(disturbed),
     .doc = "of them, those in which the host took a processor away, or page faults came that "
            "others did without: not in the statistics"},
    {"min_s", COLUMN_REAL, REAL(time.min), .flags = COLUMN_NULL, .known = has_samples,
     .doc = "wall time from the first rank's begin to the last rank's end, least"},
    {"lower_s", COLUMN_REAL, REAL(time.lower), .flags = COLUMN_NULL, .known = has_samples,
     .doc = "lower quartile"},
    {"median_s", COLUMN_REAL, REAL(time.median), .flags = COLUMN_NULL, .known = has_samples,
     .doc = "median"},
    {"upper_s", COLUMN_REAL, REAL(time.upper), .flags = COLUMN_NULL, .known = has_samples,
     .doc = "upper quartile"},
    {"max_s", COLUMN_REAL, REAL(time.max), .flags = COLUMN_NULL, .known = has_samples,
     .doc = "largest"},
    /* What else the computer did. */
    {"load_others", COLUMN_REAL, REAL(load.others), .flags = COLUMN_NULL,
     .doc = "processors that other programs kept busy meanwhile"},
    {"load_before", COLUMN_REAL, REAL(load.before), .flags = COLUMN_NULL,
     .doc = "load average of the system, 1 minute, before"},
    {"load_after", COLUMN_REAL, REAL(load.after), .flags = COLUMN_NULL, .doc = "the same after"},
    /* What the answer is worth. */
    {"same_bits", COLUMN_BOOL, REAL(same_bits),
     .doc = "1: the answer is that of the simulated run, bit by bit"},
    {"repeatable", COLUMN_BOOL, REAL(repeatable), .doc = "1: all repetitions gave the same bits"},
    {"difference", COLUMN_REAL, REAL(difference), .flags = COLUMN_NULL,
     .doc = "of the answer from the simulated one, relative"},
    {"answer", COLUMN_HEX, REAL(answer), .doc = "fingerprint of the answer"},
    {"checks", COLUMN_INT, REAL(checks), .doc = "comparisons of the answer with references"},
    {"worst_error", COLUMN_REAL, REAL(worst_error), .flags = COLUMN_NULL,
     .doc = "of the comparison nearest to its tolerance"},
    {"worst_tolerance", COLUMN_REAL, REAL(worst_tolerance), .flags = COLUMN_NULL,
     .doc = "its tolerance"},
    /* What was sent, as the simulator counts it. */
    {"messages", COLUMN_INT64, REAL(messages), .doc = "sent by all ranks in one repetition"},
    {"sent_bytes", COLUMN_INT64, REAL(bytes), .doc = "in them"},
};
const struct column_table real_result_columns = COLUMNS(real_column);

/* A stage of the program, over its ranks and repetitions. */
#define STAGE(member) .offset = offsetof(struct real_stage, member)
static const struct column stage_column[] = {
    {"name", COLUMN_CHARS, STAGE(name), .doc = "of the stage; end: ranks wait for the last one"},
    {"min_s", COLUMN_REAL, STAGE(min_s), .doc = "mean over the ranks, least of the repetitions"},
    {"median_s", COLUMN_REAL, STAGE(median_s),
     .doc = "mean over the ranks, median of the repetitions"},
    {"largest_s", COLUMN_REAL, STAGE(largest_s),
     .doc = "largest of the ranks, median of the repetitions"},
};
const struct column_table real_stage_columns = COLUMNS(stage_column);

/* One repetition as it was, disturbed or not. */
#define SAMPLE(member) .offset = offsetof(struct real_sample, member)
static const struct column sample_column[] = {
    {"seconds", COLUMN_REAL, SAMPLE(seconds), .doc = "wall time of the repetition"},
    {"disturbed", COLUMN_BOOL, SAMPLE(disturbed),
     .doc = "1: the host took a processor away meanwhile, or page faults came that "
            "others did without"},
};
const struct column_table real_sample_columns = COLUMNS(sample_column);
