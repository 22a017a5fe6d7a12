/* cmd_keys.c - mimdsim keys: the settings there are, with unit, range and default.
 *
 * Rows of the same tables that files and --set are read by. A pattern is found anywhere in a key or
 * in what is said of it, so that "bandwidth" finds every rate. */
#include <fnmatch.h>
#include <math.h>
#include <string.h>

#include "app/verb.h"
#include "base/json.h"
#include "base/text.h"
#include "plan/setting.h"
#include "spec/field.h"

static const char doc[] =
    "List the settings of scenarios, machine files and --set: key, unit, range, default, meaning. "
    "With PATTERN only those that have it in their key or their meaning; with * and ? it is for "
    "keys alone, as for files.\n\n"
    "Example: mimdsim keys bandwidth";

/* One row as it is printed. */
struct shown {
    char key[128], kind[160], range[80];
    const char *fallback, *meaning;
};

/* Whether a number is a bound at all, and not the largest number there is. */
static bool is_bound(double v) { return isfinite(v) && fabs(v) < 1e300; }

/* Range of numbers in their unit, "" for everything else. */
static void show_range(const struct field *f, struct shown *s)
{
    char low[32], high[32];
    const bool number = f->kind == FIELD_REAL || f->kind == FIELD_REALS || f->kind == FIELD_INT ||
                        f->kind == FIELD_INT64;
    s->range[0] = '\0';
    if (!number || !is_bound(f->min) || !is_bound(f->max)) return;
    units_print(f->min, f->unit, low, (int)sizeof low);
    units_print(f->max, f->unit, high, (int)sizeof high);
    /* Where 0 has a word of its own, it is no end of the range. */
    if (f->zero != NULL)
        snprintf(s->range, sizeof s->range, "above 0 to %s, or %s", high, f->zero);
    else snprintf(s->range, sizeof s->range, "%s to %s", low, high);
}

/* What a value is: its unit by an example, or the words it may be. */
static void show_kind(const struct field *f, struct shown *s)
{
    /* The same order as field_set reads them in. */
    struct text t = {0};
    if (f->choice != NULL)
        for (int i = 0; f->choice[i] != NULL; i++)
            text_add(&t, "%s%s", i > 0 ? " | " : "", f->choice[i]);
    else if (f->kind == FIELD_BOOL) text_add(&t, "true | false");
    else if (f->kind == FIELD_TEXT) text_add(&t, "text");
    else if (f->kind == FIELD_SEGMENTS) text_add(&t, "list of segments");
    else if (f->kind == FIELD_INTS || f->kind == FIELD_INT_LIST)
        text_add(&t, "list of whole numbers");
    else if (f->kind == FIELD_PAIR_LIST) text_add(&t, "list of pairs");
    else if (f->unit != UNIT_NONE)
        text_add(&t, "%s%s (%s)", f->kind == FIELD_REALS ? "list, each " : "", units_name(f->unit),
                 units_example(f->unit));
    else text_add(&t, f->kind == FIELD_REAL || f->kind == FIELD_REALS ? "number" : "whole number");
    text_copy(s->kind, sizeof s->kind, t.s);
    text_free(&t);
}

/* Everything that is told of one row. */
static struct shown show(const struct field_table *t, const struct field *f)
{
    /* The whole key, as --set takes it. */
    struct shown s = {.fallback = f->fallback, .meaning = f->doc};
    snprintf(s.key, sizeof s.key, "%s%s%s", t->prefix, t->prefix[0] != '\0' ? "." : "", f->key);
    show_kind(f, &s);
    show_range(f, &s);
    return s;
}

/* The default is shown where it says something. */
static void print_line(const struct shown *s)
{
    printf("%-40s %s%s%s", s->key, s->kind, s->range[0] != '\0' ? ", " : "", s->range);
    if (s->fallback == NULL) printf("; required");
    else if (s->fallback[0] != '\0') printf("; default %s", s->fallback);
    printf("\n%-40s   %s\n", "", s->meaning);
}

/* Keys in the order of the alphabet; a setting that has to be given has the default null. */
static void print_object(struct json *j, const struct shown *s)
{
    json_object(j);
    json_key(j, "default");
    if (s->fallback != NULL) json_text(j, s->fallback);
    else json_null(j);
    json_key_text(j, "key", s->key);
    json_key_text(j, "meaning", s->meaning);
    json_key_text(j, "range", s->range);
    json_key_text(j, "value", s->kind);
    json_end(j);
}

/* A part of the key or of its meaning; with * and ? a pattern for a part of the key. */
static bool has_pattern(const struct shown *s, const char *pattern)
{
    char part[128];
    if (strpbrk(pattern, "*?") == NULL)
        return strstr(s->key, pattern) != NULL || strcasestr(s->meaning, pattern) != NULL;
    snprintf(part, sizeof part, "*%s*", pattern);
    return fnmatch(part, s->key, 0) == 0;
}

/* All rows that have the pattern, printed unless `print` is false; how many these are. */
static int matching(const struct common *c, const char *pattern, bool print, struct json *j)
{
    /* In the order of the manual: the run, its machine, model and program. */
    int ntable, n = 0;
    const struct field_table *const *table = field_tables(&ntable);
    for (int i = 0; i < ntable; i++)
        for (int k = 0; k < table[i]->nfield; k++) {
            const struct shown s = show(table[i], &table[i]->field[k]);
            if (!has_pattern(&s, pattern)) continue;
            n++;
            if (print && c->json) print_object(j, &s);
            else if (print) print_line(&s);
        }
    return n;
}

/* A pattern that nothing has is a mistake: the message is that of an unknown key. */
int cmd_keys(int argc, char **argv)
{
    struct common c;
    struct err e;
    /* No file is read: the tables are part of the program. */
    err_clear(&e);
    common_parse(&c, argc, argv, 0, "[PATTERN]", doc, 0, 1);
    /* "n" and "level" are short for the keys that they stand for. */
    const char *pattern = c.narg > 0 ? setting_key(c.arg[0]) : "";
    /* Asked first without printing, so that a failure writes one document. */
    struct json j = json_make(stdout);
    if (matching(&c, pattern, false, &j) == 0) {
        setting_unknown("", pattern, "", 0, &e);
        return common_fail(&c, &e);
    }
    if (c.json) json_array(&j);
    matching(&c, pattern, true, &j);
    if (c.json) {
        json_end(&j);
        json_finish(&j);
    }
    return 0;
}
