/* test_command_line.c - the options that verbs share: what is read, what is refused and how that is
 * told, as text and as a document. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../support/last_words.h"
#include "../support/scratch.h"
#include "app/arguments.h"
#include "app/programs.h"
#include "app/verb.h"

/* Programs are compiled by the verbs' own rooms: none is asked for here. */
const struct program_sheet *programs_sheet(void *context, const char *path, struct arena *a,
                                           struct err *e)
{
    (void)context, (void)path, (void)a, (void)e;
    return NULL;
}

enum { MOST_WORDS = 80, EVERYTHING = 127 };

/* A command line out of a text: words between blanks. */
struct line {
    char text[2048], *word[MOST_WORDS];
    int n;
};

static void split(struct line *l, const char *text)
{
    l->n = 0;
    snprintf(l->text, sizeof l->text, "%s", text);
    l->word[l->n++] = (char *)"mimdsim run";
    for (char *save, *w = strtok_r(l->text, " ", &save); w; w = strtok_r(NULL, " ", &save)) {
        assert_true(l->n < MOST_WORDS - 1);
        l->word[l->n++] = w;
    }
    l->word[l->n] = NULL;
}

static void read_line(struct common *c, struct line *l, const char *text, int least, int most)
{
    split(l, text);
    common_parse(c, l->n, l->word, EVERYTHING, "SCENARIO", "What it does", least, most);
}

/* ---- what is read */

static void nothing_said_leaves_the_defaults(void **state)
{
    struct common c;
    struct line l;
    (void)state;
    memset(&c, 0x55, sizeof c);
    read_line(&c, &l, "", 0, 9);
    assert_string_equal(c.verb, "mimdsim run");
    assert_string_equal(c.database, "mimdsim.db");
    assert_string_equal(c.directory, "figures");
    assert_true(!c.machine && !c.name && !c.level && !c.format && !c.only);
    assert_true(!c.json && !c.quiet && !c.force && !c.brief && !c.compare && !c.allow_programs);
    assert_true(!c.database_given && c.jobs == 0 && c.nset == 0 && c.narg == 0);
    const struct plan_options o = common_plan(&c);
    assert_true(o.nset == 0 && !o.machine && !o.name && !o.only && !o.allow_programs);
    assert_true(o.nkernel > 0 && o.nkernel == c.kernel.n && o.program == programs_sheet);
}

/* In any order, among arguments, in every spelling. */
static void all_options_are_read(void **state)
{
    static const char *const text[] = {
        "a -m t3e -s n=1 --set k=2 b --name=x --only y -o db -f --dir d -j 7 --level link "
        "--brief --compare --format csv --json -q --allow-programs c",
        "a b c --machine=t3e --set=n=1 --set=k=2 --name x --only=y --output=db --force --dir=d "
        "--jobs=7 --level=link --brief --compare --format=csv --json --quiet --allow-programs",
        "--machine t3e -sn=1 -sk=2 --name x --only y -odb --force --dir d -j7 --level link "
        "--brief --compare --format csv --json --quiet --allow-programs -- a b c",
        "--mach t3e --se n=1 a --se=k=2 --na x --on y --out db --forc --di d b --jo 7 --lev link "
        "--br --comp --form csv --js --qu --allow c",
    };
    (void)state;
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        struct common c;
        struct line l;
        char words[2048];
        snprintf(words, sizeof words, "%s", text[i]);
        /* there is no short --force */
        char *f = strstr(words, " -f ");
        if (f != NULL) memmove(f + 8, f + 3, strlen(f + 3) + 1), memcpy(f, " --force", 8);
        read_line(&c, &l, words, 3, 3);
        assert_string_equal(c.machine, "t3e");
        assert_int_equal(c.nset, 2);
        assert_string_equal(c.set[0], "n=1");
        assert_string_equal(c.set[1], "k=2");
        assert_string_equal(c.name, "x");
        assert_string_equal(c.only, "y");
        assert_string_equal(c.database, "db");
        assert_string_equal(c.directory, "d");
        assert_string_equal(c.level, "link");
        assert_string_equal(c.format, "csv");
        assert_true(c.json && c.quiet && c.force && c.brief && c.compare && c.allow_programs);
        assert_true(c.database_given && c.jobs == 7 && c.narg == 3);
        for (int k = 0; k < 3; k++) assert_int_equal(c.arg[k][0], 'a' + k);
        const struct plan_options o = common_plan(&c);
        assert_true(o.set == c.set && o.nset == 2 && o.machine == c.machine && o.name == c.name);
        assert_true(o.only == c.only && o.allow_programs);
    }
}

/* Values may begin with hyphens, and behind "--" nothing is an option. */
static void hyphens_belong_to_values(void **state)
{
    struct common c;
    struct line l;
    (void)state;
    read_line(&c, &l, "--set --odd=1 -s -x --name --json -- -z --unknown", 2, 2);
    assert_int_equal(c.nset, 2);
    assert_string_equal(c.set[0], "--odd=1");
    assert_string_equal(c.set[1], "-x");
    assert_string_equal(c.name, "--json");
    assert_string_equal(c.arg[0], "-z");
    assert_string_equal(c.arg[1], "--unknown");
}

static void numbers_have_their_limits(void **state)
{
    struct common c;
    struct line l;
    (void)state;
    read_line(&c, &l, "-j 1", 0, 0);
    assert_int_equal(c.jobs, 1);
    read_line(&c, &l, "-j 256", 0, 0);
    assert_int_equal(c.jobs, 256);
    read_line(&c, &l, "-j 3 -j 5 -m a -m b", 0, 0); /* the last one counts */
    assert_true(c.jobs == 5 && strcmp(c.machine, "b") == 0);
    /* as many settings as there is room for */
    static char word[2 * COMMON_MOST_SETS + 2][8];
    static char *argv[2 * COMMON_MOST_SETS + 2];
    int n = 0;
    argv[n++] = (char *)"mimdsim run";
    for (int i = 0; i < COMMON_MOST_SETS; i++) {
        snprintf(word[n], sizeof word[n], "-s");
        argv[n] = word[n], n++;
        snprintf(word[n], sizeof word[n], "k=%d", i);
        argv[n] = word[n], n++;
    }
    common_parse(&c, n, argv, EVERYTHING, "", "", 0, 0);
    assert_int_equal(c.nset, COMMON_MOST_SETS);
    assert_string_equal(c.set[COMMON_MOST_SETS - 1], "k=255");
}

static void documents_are_wanted_before_all_is_read(void **state)
{
    static const struct {
        const char *text;
        bool wants;
    } row[] = {{"", false},
               {"--json", true},
               {"a --json b", true},
               {"--help --json", false},
               {"--json --help", false},
               {"--json -?", false},
               {"--json --usage", false},
               {"--jsonx", false},
               {"json", false}};
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct line l;
        split(&l, row[i].text);
        assert_true(common_wants_json(l.n, l.word) == row[i].wants);
    }
}

/* ---- what is refused: the process ends */

static struct {
    const char *text;
    unsigned takes;
    int least, most;
} asked;

static void parse_it(void)
{
    struct common c;
    struct line l;
    dup2(STDERR_FILENO, STDOUT_FILENO); /* a document, too, comes out of the same pipe */
    split(&l, asked.text);
    common_parse(&c, l.n, l.word, asked.takes, "SCENARIO\nQUERY", "What it does", asked.least,
                 asked.most);
    fflush(stdout);
    _exit(99); /* read without a word */
}

static void wrong_lines_are_refused(void **state)
{
    static const struct {
        const char *text;
        unsigned takes;
        int status;
        const char *words;
    } row[] = {
        {"a --jobs 0", EVERYTHING, 64, "--jobs: '0' is not a number from 1 to 256"},
        {"a --jobs 257", EVERYTHING, 64, "--jobs: '257' is not a number from 1 to 256"},
        {"a --jobs=", EVERYTHING, 64, "--jobs: '' is not a number"},
        {"a --jobs 2x", EVERYTHING, 64, "--jobs: '2x' is not a number"},
        {"a --jobs -1", EVERYTHING, 64, "--jobs: '-1' is not a number"},
        {"a --jobs 99999999999999999999", EVERYTHING, 64, "is not a number from 1 to 256"},
        {"a --output=", EVERYTHING, 64, "--output: '' is not the name of a file"},
        {"a --name=", EVERYTHING, 64, "--name: '' is no name"},
        {"", EVERYTHING, 64, "an argument is missing; expected SCENARIO,QUERY"},
        {"a b c", EVERYTHING, 64, "unexpected argument 'c'"},
        {"a --jbos 3", EVERYTHING, 64, "unknown option '--jbos'; did you mean '--jobs'?"},
        {"a --machin3=t", EVERYTHING, 64, "unknown option '--machin3'; did you mean '--machine'?"},
        {"a --zzzzzzzzz", EVERYTHING, 64, "unknown option '--zzzzzzzzz'; `mimdsim run --help`"},
        {"a --machine", EVERYTHING, 64, "machine"},
        {"a -z", EVERYTHING, 64, "z"},
        /* a group that the verb does not take is not there for it */
        {"a --machine t", 0, 64, "unknown option '--machine'"},
        {"a --output t", TAKES_PLAN, 64, "unknown option '--output'"},
        {"a --set k=1", TAKES_STORE, 64, "unknown option '--set'"},
        {"a --dir t", EVERYTHING & ~TAKES_DIR, 64, "unknown option '--dir'"},
        {"a --jobs 2", EVERYTHING & ~TAKES_JOBS, 64, "unknown option '--jobs'"},
        {"a --level l", EVERYTHING & ~TAKES_LEVEL, 64, "unknown option '--level'"},
        {"a --compare", EVERYTHING & ~TAKES_COMPARE, 64, "unknown option '--compare'"},
        {"a --format l", EVERYTHING & ~TAKES_FORMAT, 64, "unknown option '--format'"},
        /* an option of the verb's own that is not written in full */
        {"a --shar 1/2", EVERYTHING, 64, "write the option in full"},
        /* with --json a document besides */
        {"a --jobs 0 --json", EVERYTHING, 64, "\"text\": \"--jobs: '0' is not a number"},
        {"--json", EVERYTHING, 64, "\"kind\": \"usage\""},
        {"a --jbos 3 --json", EVERYTHING, 64, "\"exit_status\": 64"},
        {"a --json -z", EVERYTHING, 64, "unknown option, or one without its value"},
        {"--help", EVERYTHING, 0, "Usage: mimdsim run"},
        {"--json --help", EVERYTHING, 0, "--allow-programs"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char words[16384];
        asked.text = row[i].text, asked.takes = row[i].takes, asked.least = 1, asked.most = 2;
        const int status = words_of(parse_it, words, sizeof words);
        if (!WIFEXITED(status) || WEXITSTATUS(status) != row[i].status)
            fail_msg("row %d: status %d, '%s'", (int)i, WEXITSTATUS(status), words);
        if (strstr(words, row[i].words) == NULL) fail_msg("row %d: '%s'", (int)i, words);
    }
    /* --json, --quiet and --help are everybody's */
    char words[4096];
    asked.text = "a --json -q", asked.takes = 0;
    assert_int_equal(WEXITSTATUS(words_of(parse_it, words, sizeof words)), 99);
    assert_string_equal(words, "");
}

/* ---- arguments of several verbs */

static void numbers_of_runs_are_digits(void **state)
{
    static const struct {
        const char *text;
        bool good;
    } row[] = {{"0", true},
               {"1", true},
               {"0012", true},
               {"9223372036854775807", true},
               {"", false},
               {"-1", false},
               {"12x", false},
               {"1.5", false},
               {" 12", false},
               {"+5", false},
               {"12 ", false},
               {"0x10", false},
               {"x", false},
               {"1e3", false},
               {"-0", false},
               {"9223372036854775808", false},
               {"99999999999999999999", false}};
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct err e;
        err_clear(&e);
        errno = ERANGE; /* of something earlier */
        if (arguments_run_number(row[i].text, &e) != row[i].good)
            fail_msg("'%s' is %s", row[i].text, row[i].good ? "refused" : "taken");
        assert_true(row[i].good ? e.kind == ERR_NONE : e.kind == ERR_USAGE);
    }
}

static void write_file(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
}

/* A folder with a database, a scenario, a text, and the name of what is not there. */
struct files {
    char folder[192], db[512], scenario[512], text[512], none[512];
};

static void make_files(struct files *f, const struct common *c)
{
    struct err e;
    scratch_make(f->folder, sizeof f->folder);
    scratch_path(f->db, sizeof f->db, f->folder, "a.db");
    scratch_path(f->scenario, sizeof f->scenario, f->folder, "s.yaml");
    scratch_path(f->text, sizeof f->text, f->folder, "t.txt");
    scratch_path(f->none, sizeof f->none, f->folder, "none.db");
    write_file(f->scenario, "schema_version: 1\nmachine: t3e-300\nkernel: {name: dynamics}\n");
    write_file(f->text, "SELECT 1\n");
    err_clear(&e);
    struct store *s = arguments_store(c, f->db, &e);
    assert_non_null(s);
    store_close(s);
}

/* What is given in the place of a database is told apart. */
static void what_is_no_database_is_told(void **state)
{
    struct common c = {.verb = "mimdsim query", .quiet = true};
    struct files f;
    struct err e;
    char right[1200];
    (void)state;
    make_files(&f, &c);
    snprintf(right, sizeof right, "the database comes first: `mimdsim query %s %s`", f.db,
             f.scenario);
    const struct {
        const char *first, *second, *words;
        enum err_kind kind;
    } row[] = {
        {f.scenario, NULL, "scenario", ERR_USAGE},
        {f.scenario, f.db, right, ERR_USAGE},
        {"SELECT * FROM run", f.db, " \"SELECT * FROM run\"`", ERR_USAGE},
        {"", NULL, "'' is not the name of a database", ERR_USAGE},
        {f.none, NULL, "none.db", ERR_NO_INPUT},
        {f.text, NULL, "t.txt", ERR_DATA},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        c.arg[0] = row[i].first, c.arg[1] = row[i].second;
        c.narg = row[i].second ? 2 : 1;
        err_clear(&e);
        assert_null(arguments_database(&c, "mimdsim.db", &e));
        if (e.kind != row[i].kind ||
            (!strstr(e.text, row[i].words) && !strstr(e.file, row[i].words)))
            fail_msg("row %d: %d '%s' '%s'", (int)i, e.kind, e.file, e.text);
    }
    scratch_remove(f.folder);
}

/* The first argument, else the other name; one that is not kept leaves no file. */
static void databases_are_opened_by_name(void **state)
{
    struct common c = {.verb = "mimdsim query", .quiet = true};
    struct files f;
    struct err e;
    (void)state;
    make_files(&f, &c);
    err_clear(&e);
    c.arg[0] = f.db, c.narg = 1;
    struct store *s = arguments_database(&c, f.none, &e);
    assert_non_null(s);
    assert_string_equal(store_path(s), f.db);
    store_close(s);
    c.narg = 0;
    s = arguments_look(&c, f.db, &e);
    assert_non_null(s);
    store_close(s);
    err_clear(&e);
    assert_null(arguments_look(&c, f.none, &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    err_clear(&e);
    s = arguments_store_whole(&c, f.none, &e);
    assert_non_null(s);
    store_close(s);
    assert_int_not_equal(access(f.none, F_OK), 0);
    scratch_remove(f.folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_said_leaves_the_defaults),
        cmocka_unit_test(all_options_are_read),
        cmocka_unit_test(hyphens_belong_to_values),
        cmocka_unit_test(numbers_have_their_limits),
        cmocka_unit_test(documents_are_wanted_before_all_is_read),
        cmocka_unit_test(wrong_lines_are_refused),
        cmocka_unit_test(numbers_of_runs_are_digits),
        cmocka_unit_test(what_is_no_database_is_told),
        cmocka_unit_test(databases_are_opened_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
