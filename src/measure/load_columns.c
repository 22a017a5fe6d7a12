/* load_columns.c - the columns of every struct of load_row.h: a new result of a load curve is a
 * member there and a row here. */
#include "measure/load_row.h"

/* In the order of enum load_status. */
static const char *const status_word[] = {"ok", "wide", "unstable", "deadlock"};

/* A member of a series. */
#define SERIES(member) .offset = offsetof(struct load_series, member)

/* Only a search has found something. */
static bool was_sought(const void *row) { return ((const struct load_series *)row)->probes > 0; }

/* What the curve is, what is known of it without simulating, and what the search found. */
static const struct column series_column[] = {
    {"series", COLUMN_CHARS, SERIES(series),
     .doc = "SHA-256 of all that its points depend on: machine, traffic, seed, accuracy"},
    {"machine", COLUMN_CHARS, SERIES(machine), .doc = "its name, with what was changed of it"},
    {"routing", COLUMN_CHARS, SERIES(routing), .doc = "of the machine"},
    {"level", COLUMN_CHARS, SERIES(level), .doc = "of the network"},
    {"traffic", COLUMN_CHARS, SERIES(traffic), .doc = "pattern, or the run that was recorded"},
    {"nodes", COLUMN_INT, SERIES(nodes), .doc = "that send and receive"},
    {"message_bytes", COLUMN_INT64, SERIES(bytes), .flags = COLUMN_NULL, .absent = ABSENT_ZERO,
     .doc = "payload of a message; NULL: as recorded"},
    {"message_flits", COLUMN_REAL, SERIES(flits),
     .doc = "of a message, headers included; the mean"},
    {"cycle_ps", COLUMN_REAL, SERIES(cycle_ps), .doc = "time of a flit on a link"},
    /* Known before anything is simulated: closed forms. */
    {"empty_ps", COLUMN_REAL, SERIES(empty_ps), .doc = "mean latency in the empty network"},
    {"bound", COLUMN_REAL, SERIES(bound), .flags = COLUMN_NULL,
     .doc = "load that the most loaded link permits, by the routes alone; NULL: not known"},
    /* Of the search, by its two nearest loads that could be told. */
    {"saturation", COLUMN_REAL, SERIES(saturation), .flags = COLUMN_NULL, .known = was_sought,
     .doc = "load at which the mean latency is three times empty_ps; NULL: none up to 1, or not "
            "sought"},
    {"saturation_low", COLUMN_REAL, SERIES(low), .flags = COLUMN_NULL, .known = was_sought,
     .doc = "the highest load tried that surely stays below"},
    {"saturation_high", COLUMN_REAL, SERIES(high), .flags = COLUMN_NULL, .known = was_sought,
     .doc = "the lowest load tried that surely does not"},
    {"probes", COLUMN_INT, SERIES(probes), .doc = "loads that were tried to find it"},
    {"note", COLUMN_CHARS, SERIES(note), .doc = "what is to be known of these numbers"},
};
const struct column_table load_series_columns = COLUMNS(series_column);

/* A member of a point. */
#define POINT(member) .offset = offsetof(struct load_point, member)
/* A latency in whole picoseconds, printed in nanoseconds. */
#define LATENCY(name, heading, member, ...)                                                        \
    {                                                                                              \
        name, COLUMN_INT64, POINT(member), .flags = COLUMN_NULL, .absent = ABSENT_NEGATIVE,        \
                                           .title = heading, .width = 11, .style = 'f',            \
                                           .digits = 1, .scale = 1e-3, __VA_ARGS__                 \
    }

/* A point: the question, what got through, latencies, and how they were come by. */
static const struct column point_column[] = {
    {"offered", COLUMN_REAL, POINT(offered), .title = "offered", .width = 9, .style = 'f',
     .digits = 4, .doc = "flits per node and cycle of a link that were asked for"},
    {"probe", COLUMN_BOOL, POINT(probe), .doc = "1: of the search for saturation"},
    {"status", COLUMN_WORD, POINT(status), WORDS(status_word), .title = "status", .before = " ",
     .width = -9,
     .doc = "ok; wide: its mean is less closely known than asked; unstable: the backlog grows"},
    /* What came in and what got out, over the same time; of every point. */
    {"created", COLUMN_REAL, POINT(created), .flags = COLUMN_NULL,
     .doc = "flits per node and cycle that were really offered while it was measured"},
    {"accepted", COLUMN_REAL, POINT(accepted), .flags = COLUMN_NULL, .title = "accepted",
     .width = 9, .style = 'f', .digits = 4, .doc = "that were delivered while it was measured"},
    /* Latencies, of points with a steady state. */
    {"mean_ps", COLUMN_REAL, POINT(mean_ps), .flags = COLUMN_NULL, .title = "mean_ns", .width = 11,
     .style = 'f', .digits = 1, .scale = 1e-3,
     .doc = "latency from creation to the last flit; NULL here and below: no steady state"},
    {"half_ps", COLUMN_REAL, POINT(half_ps), .flags = COLUMN_NULL, .title = "+-_ns", .width = 9,
     .style = 'f', .digits = 1, .scale = 1e-3,
     .doc = "half the width of the 95 % confidence interval of the mean, by batch means"},
    LATENCY("p50_ps", "p50_ns", p50_ps, .doc = "median"),
    LATENCY("p99_ps", "p99_ns", p99_ps, .doc = "99 % of the messages take at most this"),
    LATENCY("max_ps", "max_ns", max_ps, .doc = "of the slowest message"),
    /* What the numbers rest on. */
    {"messages", COLUMN_INT64, POINT(messages), .title = "messages", .width = 10,
     .doc = "that were measured"},
    LATENCY("warmup_ps", "warmup_ns", warmup_ps, .doc = "left out at the beginning, by MSER-5"),
    {"length_ps", COLUMN_INT64, POINT(length_ps), .doc = "simulated time"},
    {"batch_lag", COLUMN_REAL, POINT(lag), .flags = COLUMN_NULL,
     .doc = "lag-1 autocorrelation of the batch means, which the interval presumes to be small"},
    {"events", COLUMN_INT64, POINT(events), .doc = "dispatched by the simulator"},
    {"host_s", COLUMN_REAL, POINT(host_s), .doc = "processor time of this computer"},
    {"text", COLUMN_CHARS, POINT(text), .title = "", .before = "  ",
     .doc = "of a deadlock: its cycle"},
};
const struct column_table load_point_columns = COLUMNS(point_column);
