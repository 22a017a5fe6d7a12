/* study_columns.c - the columns of every struct of study_row.h: a new result of a study is a member
 * there and a row here. */
#include <string.h>

#include "measure/run_row.h"
#include "measure/study_row.h"

/* Of rungs and grades alike. */
static const char *const status_word[] = {"ok", "degraded", "failed"};

/* --- ladders --------------------------------------------------------------- */

/* Where a member of a rung lies. */
#define RUNG(member) .offset = offsetof(struct accuracy_rung, member)

/* A network level is method and rung at once: its name is not printed a second time. */
static void read_rung(const struct column *c, const void *row, struct column_value *v)
{
    const struct accuracy_rung *x = row;
    (void)c;
    v->kind = VALUE_TEXT;
    v->text = strcmp(x->method, x->rung) == 0 ? "" : x->rung;
}

/* Columns of a rung: the table of the database, the list in JSON, and the terminal's columns
 * (those with a title). */
static const struct column rung_column[] = {
    {"ladder", COLUMN_CHARS, RUNG(ladder), .doc = "network, arithmetic or integration"},
    {"at", COLUMN_CHARS, RUNG(at), .doc = "point of the scenario: \"n=P=128\""},
    {"family", COLUMN_CHARS, RUNG(family), .flags = COLUMN_NO_JSON,
     .doc = "SHA-256 of the settings without sizes, level and seeds: what it holds for"},
    {"method", COLUMN_CHARS, RUNG(method), .title = "method", .before = "  ", .width = -24,
     .doc = "a curve"},
    {"rung", COLUMN_CHARS, RUNG(rung), .doc = "a point on it: level, step size, tolerance"},
    {"rung_shown", COLUMN_STRING, .value = read_rung, .flags = COLUMN_NO_SQL | COLUMN_NO_JSON,
     .title = "rung", .before = " ", .width = -18,
     .doc = "as `rung`, blank where that is the method"},
    {"quantity", COLUMN_CHARS, RUNG(quantity), .doc = "what was compared"},
    {"reference", COLUMN_CHARS, RUNG(reference), .doc = "with what"},
    {"status", COLUMN_WORD, RUNG(status), WORDS(status_word), .title = "status", .before = " ",
     .width = -9, .doc = "whether the error is small, tolerable, or there is no answer"},
    {"relative_error", COLUMN_REAL, RUNG(error), .flags = COLUMN_NULL, .key = "error",
     .title = "error", .width = 10, .style = 'e', .digits = 2,
     .doc = "NULL: failed, or not finite"},
    {"host_s", COLUMN_REAL, RUNG(host_s), .flags = COLUMN_NULL, .title = "host_ms", .width = 12,
     .style = 'f', .digits = 4, .scale = 1e3, .doc = "time on this computer"},
    {"machine_ps", COLUMN_INT64, RUNG(machine_ps), .flags = COLUMN_NULL, .absent = ABSENT_NEGATIVE,
     .key = "machine_s", .json_scale = 1e-12, .title = "machine_us", .width = 14, .style = 'f',
     .digits = 3, .scale = 1e-6, .doc = "predicted time on the machine"},
    {"text", COLUMN_CHARS, RUNG(text), .title = "", .before = "  ",
     .doc = "why it failed; processors used"},
};
const struct column_table accuracy_rung_columns = COLUMNS(rung_column);

/* Where a member of a choice lies, which points to its rung. */
#define CHOICE(member) .offset = offsetof(struct accuracy_choice, member)
/* A column that lies in the chosen rung; absent where none is within the tolerance. */
#define CHOSEN(member)                                                                             \
    .part = PART(struct accuracy_choice, rung), .offset = offsetof(struct accuracy_rung, member),  \
    .known = has_rung

/* Whether any rung is within the tolerance. */
static bool has_rung(const void *row)
{
    return ((const struct accuracy_choice *)row)->rung != NULL;
}

/* Columns of a choice: what was asked, the cheapest rung within the tolerance, and what the most
 * accurate one would cost. */
static const struct column choice_column[] = {
    {"ladder", COLUMN_STRING, CHOICE(ladder), .doc = "network, arithmetic or integration"},
    {"at", COLUMN_STRING, CHOICE(at), .flags = COLUMN_NO_JSON, .doc = "point of the scenario"},
    {"quantity", COLUMN_STRING, CHOICE(quantity), .doc = "what was compared"},
    {"tolerance", COLUMN_REAL, CHOICE(tolerance), .doc = "largest error asked for"},
    {"method", COLUMN_CHARS, CHOSEN(method), .flags = COLUMN_NULL,
     .doc = "NULL: no rung is within the tolerance"},
    {"rung", COLUMN_CHARS, CHOSEN(rung), .flags = COLUMN_NULL,
     .doc = "the cheapest within the tolerance"},
    {"relative_error", COLUMN_REAL, CHOSEN(error), .flags = COLUMN_NULL, .key = "error",
     .doc = "of that rung"},
    {"cost_ratio", COLUMN_REAL, CHOICE(cost_ratio), .known = has_rung, .flags = COLUMN_NULL,
     .doc = "of the finest rung's cost to this one's"},
};
const struct column_table accuracy_choice_columns = COLUMNS(choice_column);

/* --- stability ------------------------------------------------------------- */

static const char *const cause_word[] = {"", "rounding", "algorithm-fails"};

#define GRADE(member) .offset = offsetof(struct stability_row, member)
/* A number that may be missing, nine places wide under `heading`. */
#define NUMBER(name, heading, member, ...)                                                         \
    {                                                                                              \
        name, COLUMN_REAL, GRADE(member), .flags = COLUMN_NULL, .title = heading, .width = 9,      \
                                          .style = 'e', .digits = 1, __VA_ARGS__                   \
    }

/* One row, as the database, JSON and the terminal have it. `cause` is not in the database:
 * `reason` says the same in words. */
static const struct column stability_column[] = {
    {"subject", COLUMN_CHARS, GRADE(subject), .key = "case", .title = "case", .width = -27,
     .doc = "the case"},
    {"algorithm", COLUMN_CHARS, GRADE(algorithm), .title = "algorithm", .before = " ", .width = -22,
     .doc = "that was asked"},
    {"precision", COLUMN_CHARS, GRADE(precision), .title = "prec", .before = " ", .width = -7,
     .doc = "of its numbers"},
    {"status", COLUMN_WORD, GRADE(status), WORDS(status_word), .title = "status", .before = " ",
     .width = -9,
     .doc = "in double precision ok to 1e-8, degraded to 1e-2; in single 1e-3 and 1e-1"},
    NUMBER("relative_error", "error", error, .key = "error", .doc = "NULL: no number"),
    NUMBER("residual", "residual", residual,
           .doc = "of the equation of motion over the largest joint force; with loops of the "
                  "constraints"),
    NUMBER("condition", "cond", condition,
           .doc = "of the case: change of the answer over that of the inputs"),
    NUMBER("growth", "growth", growth,
           .doc = "of the reduction: largest diagonal element over its last pivot"),
    {"refinements", COLUMN_INT, GRADE(refinements), .flags = COLUMN_NULL, .absent = ABSENT_NEGATIVE,
     .title = "ref", .width = 4, .doc = "corrections that were applied, inner and outer"},
    NUMBER("energy_drift", "energy", energy_drift,
           .doc = "of motions, relative; of accelerations: power of the error"),
    NUMBER("step_s", "step", step_s, .doc = "largest stable or mean step, of integrators"),
    {"cause", COLUMN_WORD, GRADE(cause), WORDS(cause_word), .flags = COLUMN_NO_SQL,
     .doc = "why it is not ok"},
    {"reason", COLUMN_CHARS, GRADE(reason), .title = "", .before = "  ",
     .doc = "why it is not ok, in words, and what helps"},
};
const struct column_table stability_columns = COLUMNS(stability_column);

/* --- savings --------------------------------------------------------------- */

#define SAVING(member) .offset = offsetof(struct saving, member)

/* An omission that cannot be undone has no times. */
static bool is_measured(const void *row) { return ((const struct saving *)row)->measured; }

static const char *const class_word[] = {"exact", "bounded"};

/* exact: no result changes; bounded: by at most `bound`, relative. */
static void read_class(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    v->kind = VALUE_TEXT;
    v->text = omission_class(&((const struct saving *)row)->omission);
}

/* Columns of one omission. Those of the class are not in the JSON of this list, where the list
 * of omissions has them. */
static const struct column saving_column[] = {
    {"at", COLUMN_CHARS, SAVING(at), .doc = "point of the scenario that was measured: \"n=P=128\""},
    {"host_s", COLUMN_REAL, SAVING(host_s), .flags = COLUMN_NULL,
     .doc = "of the run without it; NULL here and below: nothing brings it back"},
    {"host_saved_s", COLUMN_REAL, SAVING(host_saved_s), .flags = COLUMN_NULL,
     .doc = "what leaving it out saves"},
    {"host_noise_s", COLUMN_REAL, SAVING(noise_s), .flags = COLUMN_NULL,
     .doc = "savings below it cannot be told from nothing"},
    {"machine_ps", COLUMN_INT64, SAVING(machine_ps), .known = is_measured, .flags = COLUMN_NULL,
     .key = "machine_s", .json_scale = 1e-12, .doc = "predicted time of the run without it"},
    {"machine_saved_ps", COLUMN_INT64, SAVING(machine_saved_ps), .known = is_measured,
     .flags = COLUMN_NULL, .key = "machine_saved_s", .json_scale = 1e-12,
     .doc = "what leaving it out saves of that"},
    {"what", COLUMN_CHARS, SAVING(omission.what), .doc = "was left out"},
    {"why", COLUMN_CHARS, SAVING(omission.why), .flags = COLUMN_NO_JSON,
     .doc = "why no result needs it"},
    {"class", COLUMN_WORD, .value = read_class, WORDS(class_word), .flags = COLUMN_NO_JSON,
     .doc = "exact: the results are the same numbers; bounded: to within `bound`"},
    {"bound", COLUMN_REAL, SAVING(omission.bound), .absent = ABSENT_ZERO,
     .flags = COLUMN_NULL | COLUMN_NO_JSON,
     .doc = "largest relative change of a result, of bounded ones"},
};
const struct column_table saving_columns = COLUMNS(saving_column);
