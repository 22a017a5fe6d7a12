/* cmd_lists.c - mimdsim scenarios and kernels: what there is.
 *
 * The manual of all keys is made from the tables of fields, so that it cannot be out of date. */
#include "app/flag.h"
#include "app/verb.h"
#include "base/arena.h"
#include "base/text.h"
#include "run/catalogue.h"
#include "spec/field.h"

static const char scenarios_help[] =
    "List the scenarios, each with its question.\n\n"
    "Example: mimdsim scenarios\n"
    "\v--keys: list instead all keys of scenarios, machine files and --set, with meaning, unit "
    "and default, as Markdown.";

/* What only files have, and how their keys are shortened; the settings themselves have their
 * tables. */
static const char keys_of_files[] =
    "## A scenario\n\n"
    "- `schema_version`: 1.\n"
    "- `question`: one line of text.\n"
    "- `machine`, `kernel`, `level`, `n`: abbreviations of `machine.name` (or a file), "
    "`kernel.name`, `machine.network.level`, `model.n`.\n"
    "- `program`: abbreviation of `program.file`, a program of your own instead of `kernel`; what "
    "it declares are keys, too.\n"
    "- `ranks`: a number, or `n` for one rank per body.\n"
    "- `n_over_p`: bodies per processor, instead of `n`.\n"
    "- `sweep`: keys with lists of values, combined in every way: `{n: [8, 64], kernel.solver: "
    "[cr, pcr]}`; a list instead of a value does the same.\n"
    "- `only`: run only these points: `n >= ranks`, `ranks <= processors`.\n"
    "- `repetitions`: number of runs of a point that has noise, with different seeds.\n"
    "- `figures`: the figures that `mimdsim paper` draws from it.\n\n"
    "Give the settings below as `kernel: {solver: cr}` or `kernel.solver: cr`, or with `--set "
    "kernel.solver=cr`. A machine file has the settings of `machine` without that word, "
    "`schema_version`, and `base`, the machine that it starts from.\n\n";

/* Every key with its meaning, in the order of the manual: Markdown for people, pairs for
 * programs. */
static void print_keys(const struct common *c)
{
    if (!c->json) {
        fputs(keys_of_files, stdout);
        fields_document(stdout);
        return;
    }
    struct arena *a = arena_create();
    int ntable, n = 0, most = 0; /* tables; keys so far; keys of all tables */
    const struct field_table *const *table = field_tables(&ntable);
    /* Room for all keys of all tables. */
    for (int i = 0; i < ntable; i++) most += table[i]->nfield;
    const char **key = TAKE(a, most, const char *);
    const char **meaning = TAKE(a, most, const char *);
    for (int i = 0; i < ntable; i++) {
        for (int j = 0; j < table[i]->nfield; j++, n++) {
            /* The whole key: a table's prefix and the field's name. */
            struct text t = {0};
            text_add(&t, "%s%s%s", table[i]->prefix, table[i]->prefix[0] != '\0' ? "." : "",
                     table[i]->field[j].key);
            key[n] = arena_text(a, t.s);
            text_free(&t);
            meaning[n] = table[i]->field[j].doc;
        }
    }
    common_print_pairs(c, n, key, meaning);
    arena_destroy(a);
}

/* Questions of the shipped scenarios and of the user's own. */
int cmd_scenarios(int argc, char **argv)
{
    struct common c;
    bool keys = take_flag(&argc, argv, "--keys");
    common_parse(&c, argc, argv, 0, "", scenarios_help, 0, 0);
    /* --keys needs no scenario to be readable. */
    if (keys) {
        print_keys(&c);
        return 0;
    }
    struct err e;
    err_clear(&e);
    struct arena *a = arena_create();
    const char **stem, **title;
    int n, status = 0;
    if (plan_list("scenarios", a, &stem, &title, &n, &e)) common_print_pairs(&c, n, stem, title);
    else status = common_fail(&c, &e);
    arena_destroy(a);
    return status;
}

/* Only the built-in ones: programs of your own are files. */
int cmd_kernels(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "", 
                 "List the built-in programs; `mimdsim programs` lists examples and your own, "
                 "too.\n\n"
                 "Example: mimdsim kernels\n", 0, 0);
    /* Names and titles from the table of programs. */
    struct catalogue k = catalogue_of_kernels();
    common_print_pairs(&c, k.n, k.name, k.title);
    return 0;
}
