/* cmd_machines.c - mimdsim machines: list, show one with the origin of every value, compare two.
 *
 * Every value is shown with its evidence and source: a prediction rests on these numbers, so a
 * user must be able to check and change each. */
#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "app/machine_topology.h"
#include "app/parameters.h"
#include "app/verb.h"
#include "base/json.h"
#include "measure/column.h"
#include "study/rates.h"

static const char doc[] =
    "List the machines; with NAME, show one with the source of each value.\n\n"
    "Example: mimdsim machines t3e-300\n"
    "         mimdsim machines --compare t3e-300 t3e-300-mpt\n"
    "         mimdsim machines what-if-dragonfly what-if-hyperx --topology\n";

/* A machine, and where each of its values comes from. */
struct shown {
    struct machine_spec spec; /* with --set applied */
    struct origin *origin; /* (n) in the arena */
    int n;
};

/* Every machine with its title. */
static int list_machines(const struct common *c, struct arena *a)
{
    struct err e;
    err_clear(&e);
    const char **stem, **title;
    int n;
    if (!plan_list("machines", a, &stem, &title, &n, &e)) return common_fail(c, &e);
    common_print_pairs(c, n, stem, title);
    return 0;
}

/* A value of struct origin at its place. */
#define ORIGIN(member) .offset = offsetof(struct origin, member)

/* One value with its origin. Values are texts with units, as in the file; ranges are numbers in
 * SI. */
static const struct column origin_column[] = {
    {"evidence", COLUMN_STRING, ORIGIN(evidence), .doc = "P, PR, D or E"},
    {"file", COLUMN_STRING, ORIGIN(file), .doc = "where it is given"},
    {"key", COLUMN_STRING, ORIGIN(key), .doc = "its name"},
    {"line", COLUMN_INT, ORIGIN(line), .doc = "of the file"},
    {"max", COLUMN_REAL, ORIGIN(max), .doc = "largest published value, in SI units"},
    {"min", COLUMN_REAL, ORIGIN(min), .doc = "least published value, in SI units"},
    {"source", COLUMN_STRING, ORIGIN(source), .doc = "citation or arithmetic"},
    {"validate", COLUMN_STRING, ORIGIN(validate), .doc = "published figure that uses it"},
    {"value", COLUMN_STRING, ORIGIN(value), .doc = "with its unit"},
};
static const struct column_table origin_columns = COLUMNS(origin_column);

/* A list of segments is long: one on a line, below its key. */
static void print_segments(const char *list)
{
    for (const char *s = strchr(list, '{'); s != NULL; s = strchr(s + 1, '{'))
        printf("    %.*s\n", (int)strcspn(s, "}") + 1, s);
}

/* Value, range, evidence and place in columns; the source, of any length, at the end. */
static void print_origin(const struct origin *o, struct arena *a)
{
    /* Without folders: all files lie in machines/, but for the user's own. */
    const char *slash = strrchr(o->file, '/');
    const bool segments = o->value[0] == '[' && o->value[1] == '{';
    printf("%-36s %-22s %-30s %-3s ", o->key, segments ? "by size:" : o->value,
           parameters_range(o, a), o->evidence);
    if (o->line) printf("%s:%d", slash ? slash + 1 : o->file, o->line);
    else printf("%s", slash ? slash + 1 : o->file);
    if (*o->source) printf("  %s", o->source);
    if (*o->validate)
        printf("; %s%s", strncmp(o->validate, "unused", 6) == 0 ? "" : "validate: ", o->validate);
    putchar('\n');
    if (segments) print_segments(o->value);
}

/* NULL: this machine has no such value. */
static const struct origin *value_of(const struct shown *m, const char *key)
{
    for (int i = 0; i < m->n; i++)
        if (strcmp(m->origin[i].key, key) == 0) return &m->origin[i];
    return NULL;
}

/* A number as the file states it, and the least and largest that it gives for it. */
struct bounds {
    double low, value, high;
};

/* How far the rate of small dense code is known, and with it the LINPACK benchmark of order 100:
 * at the least, the stated and the largest rate of the file [flop/s]. A published LINPACK result
 * is the one number of many old machines, so it is compared here. */
struct sustained {
    struct bounds linpack_100, small_dense;
};

/* LINPACK's operations are counted once and priced three times. */
static struct sustained sustained_rate(const struct shown *m)
{
    const struct origin *o = value_of(m, "node.flop_rate");
    /* Without a published range the three rates are one. */
    const bool ranged = o->max > o->min;
    const double stated = m->spec.node.flop_rate;
    struct sustained s = {
        .small_dense = {ranged ? o->min : stated, stated, ranged ? o->max : stated}};
    /* The same three prices for the benchmark. */
    const double rate[] = {s.small_dense.low, stated, s.small_dense.high};
    double *const linpack[] = {&s.linpack_100.low, &s.linpack_100.value, &s.linpack_100.high};
    struct rate_count count = rate_linpack(100);
    for (int i = 0; i < 3; i++) {
        struct node_spec node = m->spec.node;
        node.flop_rate = rate[i];
        *linpack[i] = rate_of(&node, &count);
    }
    return s;
}

/* One line on top of a machine: the parameter that decides most predictions. */
static void print_sustained(const struct shown *m)
{
    const struct sustained s = sustained_rate(m);
    const struct origin *published = value_of(m, "published.linpack_100");
    /* Without bounds the one number stands alone. */
    const bool bounded = s.small_dense.low < s.small_dense.high;
    printf("sustained rate of small dense code: %.4g Mflop/s, ", s.small_dense.value / 1e6);
    if (bounded)
        printf("known within %.4g to %.4g; ", s.small_dense.low / 1e6, s.small_dense.high / 1e6);
    else
        printf("no bounds given; ");
    printf("LINPACK 100 with it: %.4g", s.linpack_100.value / 1e6);
    if (bounded) printf(", %.4g to %.4g", s.linpack_100.low / 1e6, s.linpack_100.high / 1e6);
    if (published) printf(", published %s", published->value);
    putchar('\n');
}

/* ---- one machine as a document: tables of columns within tables ---- */

/* A value of struct bounds at its place; keys stand in the order of the alphabet. */
#define RANGE(member) COLUMN_REAL, .offset = offsetof(struct bounds, member)

static const struct column range_column[] = {
    {"high", RANGE(high), .doc = "with the largest rate of the file [flop/s]"},
    {"low", RANGE(low), .doc = "with the least"},
    {"value", RANGE(value), .doc = "as the file states it"},
};
static const struct column_table range_columns = COLUMNS(range_column);

/* A row within a row. */
static void put_range(const struct column *c, const void *row, struct json *j)
{
    columns_json(&range_columns, (const char *)row + c->offset, j);
}

/* Two rows of three rates each. */
#define SUSTAINED(member) .json = put_range, .offset = offsetof(struct sustained, member)

static const struct column sustained_column[] = {
    {"linpack_100", COLUMN_REAL, SUSTAINED(linpack_100), .doc = "LINPACK of order 100"},
    {"small_dense", COLUMN_REAL, SUSTAINED(small_dense), .doc = "small dense code"},
};
static const struct column_table sustained_columns = COLUMNS(sustained_column);

/* Counted, not stored: the topology says it. */
static void read_processors(const struct column *c, const void *row, struct column_value *v)
{
    const struct shown *m = row;
    (void)c;
    v->kind = VALUE_INT;
    v->integer = machine_spec_processors(&m->spec);
}

/* Computed when it is asked for: three prices of one benchmark. */
static void put_sustained(const struct column *c, const void *row, struct json *j)
{
    const struct sustained s = sustained_rate(row);
    (void)c;
    columns_json(&sustained_columns, &s, j);
}

/* The list that the terminal shows, too. */
static void put_values(const struct column *c, const void *row, struct json *j)
{
    const struct shown *m = row;
    (void)c;
    columns_json_list(&origin_columns, m->origin, m->n, sizeof *m->origin, j);
}

/* What a document says of a machine: its name and size, the rate that decides most predictions,
 * then every value. */
#define SHOWN(member) .offset = offsetof(struct shown, spec.member)

static const struct column machine_column[] = {
    {"name", COLUMN_CHARS, SHOWN(name), .doc = "of its file"},
    {"processors", COLUMN_INT64, .value = read_processors, .doc = "that programs can use"},
    {"sustained_rate", COLUMN_REAL, .json = put_sustained, .doc = "how far it is known"},
    {"title", COLUMN_CHARS, SHOWN(title), .doc = "for people"},
    {"values", COLUMN_STRING, .json = put_values, .doc = "every value with its origin"},
};
static const struct column_table machine_columns = COLUMNS(machine_column);

/* A machine for people, or as one document. */
static void show_one(const struct common *c, const struct shown *m, struct arena *a)
{
    if (!c->json) {
        /* Name and size, the rate that decides most, then every value. */
        printf("%s: %s, %lld processors\n", m->spec.name, m->spec.title,
               (long long)machine_spec_processors(&m->spec));
        print_sustained(m);
        printf("\n%-36s %-22s %-30s %-3s %s\n", "key", "value", "range", "ev.", "where, source");
        for (int i = 0; i < m->n; i++) print_origin(&m->origin[i], a);
        return;
    }
    /* For programs: the same, from the tables above. */
    struct json j = json_make(stdout);
    columns_json(&machine_columns, m, &j);
    json_finish(&j);
}

/* A key with its two values, keys of the object sorted by name: the machines' names are keys, so
 * their order depends on them. A machine compared with one of its own name is "NAME (2)". */
static void difference_json(struct json *j, const char *key, const struct shown *x,
                            const char *xvalue, const struct shown *y, const char *yvalue)
{
    char second[sizeof y->spec.name + 8];
    bool alike = strcmp(x->spec.name, y->spec.name) == 0;
    snprintf(second, sizeof second, "%s%s", y->spec.name, alike ? " (2)" : "");
    const char *name[] = {"key", x->spec.name, second}, *value[] = {key, xvalue, yvalue};
    bool swap = strcmp(name[1], name[2]) > 0;
    int order[] = {0, swap ? 2 : 1, swap ? 1 : 2};
    /* Two steps of insertion are enough for three. */
    for (int i = 0; i < 2 && strcmp(name[order[i]], name[order[i + 1]]) > 0; i++) {
        int first = order[i];
        order[i] = order[i + 1];
        order[i + 1] = first;
    }
    json_object(j);
    for (int i = 0; i < 3; i++) {
        json_key_text(j, name[order[i]], value[order[i]]);
    }
    json_end(j);
}

/* Only what differs; "-" stands for what one of them does not have. */
static void print_difference(const struct common *c, struct json *j, const char *key,
                             const struct shown *m, const struct origin *const o[2])
{
    const char *x = o[0] ? o[0]->value : "-", *y = o[1] ? o[1]->value : "-";
    if (strcmp(x, y) == 0) return;
    if (c->json) difference_json(j, key, &m[0], x, &m[1], y);
    else printf("%-36s %-26s %s\n", key, x, y);
}

/* Values are paired by their names: every machine has the keys of the table, and published
 * figures of its own. The second pass finds those that only the second machine has. */
static void compare(const struct common *c, const struct shown m[2])
{
    struct json j = json_make(stdout);
    if (c->json) json_array(&j);
    else printf("%-36s %-26s %s\n", "key", m[0].spec.name, m[1].spec.name);
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < m[side].n; i++) {
            const char *key = m[side].origin[i].key;
            const struct origin *const o[2] = {value_of(&m[0], key), value_of(&m[1], key)};
            if (side == 0 || !o[0]) print_difference(c, &j, key, m, o);
        }
    if (c->json) {
        json_end(&j);
        json_finish(&j);
    }
}

/* One machine is shown, two are compared; --set changes both. */
static int show(const struct common *c, struct arena *a)
{
    struct shown m[2] = {0};
    struct plan_options o = common_plan(c);
    for (int i = 0; i < c->narg; i++) {
        struct err e;
        err_clear(&e);
        if (!plan_machine(&m[i].spec, c->arg[i], &o, a, &m[i].origin, &m[i].n, &e))
            return common_fail(c, &e);
    }
    if (c->narg == 1) show_one(c, &m[0], a);
    else compare(c, m);
    return 0;
}

/* No argument: the list; one: that machine; two with --compare. */
int cmd_machines(int argc, char **argv)
{
    struct common c;
    /* Any number of networks side by side, but one machine or two in full. */
    bool topology = take_flag(&argc, argv, "--topology");
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_COMPARE | TAKES_DIR,
                 "[NAME]\n--compare NAME OTHER\nNAME... --topology", doc, 0, topology ? 64 : 2);
    /* argp counts arguments without knowing --compare. */
    if (c.compare && c.narg != 2) {
        struct err e;
        err_clear(&e);
        err_set(&e, ERR_USAGE, "--compare needs two machines, not %d", c.narg);
        return common_fail(&c, &e);
    }
    /* Machines have no points. */
    if (c.only != NULL) {
        struct err e;
        err_clear(&e);
        err_set(&e, ERR_USAGE, "--only picks points of a scenario; a machine has none");
        return common_fail(&c, &e);
    }
    struct arena *a = arena_create();
    int status = topology ? machine_topology(&c, a) : c.narg ? show(&c, a) : list_machines(&c, a);
    arena_destroy(a);
    return status;
}
