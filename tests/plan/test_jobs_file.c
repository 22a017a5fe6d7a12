/* test_jobs_file.c - `jobs:` of a scenario: which runs it makes, where the jobs lie, and every line
 * that is none. */
#include "base/random.h"
#include "scratch.h"

/* A machine of 32 processors; what follows is the scenario's. */
#define TOP                                                                                        \
    "schema_version: 1\nquestion: what?\nmachine: t3e-300\nmachine.topology.dims: [4, 4, 2]\n"     \
    "level: link\n"
enum { TOP_LINES = 5, PROCESSORS = 32 };

static struct plan read_jobs(const char *text, const char *const *set, int nset)
{
    char whole[4096];
    snprintf(whole, sizeof whole, TOP "%s", text);
    return scratch_plan(scratch_write(&scratch, "s.yaml", whole), set, nset);
}

/* ---- combinations */

static const char four[] = "jobs:\n"
                           "- {name: a, kernel: forward, n: 16, ranks: 8}\n"
                           "- {name: b, kernel: inverse, n: 12, ranks: 4, start: 2 us}\n"
                           "- {name: c, kernel: all-to-all, ranks: 2}\n"
                           "- {name: d, kernel: barrier, ranks: 1}\n";

/* The runs that `words` asks for, counted by hand: subsets of the four jobs without repetition, a
 * run for each member. */
static void combinations_are_subsets_with_a_run_for_each_member(void **state)
{
    (void)state;
    static const struct {
        const char *words;
        int runs;
    } asked[] = {{NULL, 4},
                 {"all", 4},
                 {"alone", 4},
                 {"pairs", 12},
                 {"[alone, pairs]", 16},
                 {"[pairs, alone, pairs]", 16},
                 {"[all, alone]", 8},
                 {"[alone, pairs, all]", 20}};
    for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
        char text[1024];
        snprintf(text, sizeof text, "%s%s%s\n", four, asked[i].words ? "combinations: " : "",
                 asked[i].words ? asked[i].words : "");
        struct plan p = read_jobs(text, NULL, 0);
        assert_int_equal(p.nrun, asked[i].runs);
        for (int k = 0; k < p.nrun; k++) {
            const struct run_spec *r = &p.run[k];
            static const char *const name[] = {"a", "b", "c", "d"};
            static const int ranks[] = {8, 4, 2, 1};
            const int number = r->job.number;
            assert_in_range(number, 1, 4);
            assert_string_equal(r->job.name, name[number - 1]);
            assert_int_equal(r->nrank, ranks[number - 1]);
            assert_true(r->job.start == (number == 2 ? 2e-6 : 0));
            /* idle jobs keep their place in the set: it is the same in every combination */
            assert_int_equal(r->jobs->n, 4);
            assert_false(r->jobs->idle[number - 1]);
            assert_string_equal(r->job.set, p.run[0].job.set);
            /* the names beside it are those that run and are not its own */
            char beside[JOB_BESIDE] = "";
            for (int j = 0; j < 4; j++)
                if (j != number - 1 && !r->jobs->idle[j])
                    snprintf(beside + strlen(beside), sizeof beside - strlen(beside), "%s%s",
                             beside[0] ? " + " : "", name[j]);
            assert_string_equal(r->job.beside, beside);
            /* each run is another one */
            for (int j = 0; j < k; j++)
                assert_string_not_equal(p.run[j].config_hash, r->config_hash);
        }
        plan_free(&p);
    }
}

static void two_jobs_are_a_pair_and_all_at_once(void **state)
{
    (void)state;
    static const char two[] = "jobs:\n- {name: a, kernel: barrier, ranks: 2}\n"
                              "- {name: b, kernel: barrier, ranks: 2}\n"
                              "combinations: [pairs, all, alone]\n";
    struct plan p = read_jobs(two, NULL, 0);
    assert_int_equal(p.nrun, 4);
    plan_free(&p);
    static const char one[] = "jobs: [{name: only, kernel: barrier, ranks: 2}]\n"
                              "combinations: [all, alone]\n";
    p = read_jobs(one, NULL, 0);
    assert_int_equal(p.nrun, 1);
    assert_string_equal(p.run[0].job.beside, "");
    plan_free(&p);
}

static void settings_reach_one_job_alone(void **state)
{
    (void)state;
    static const char *const set[] = {"jobs.b.n=20", "jobs.c.start=5 us", "combinations=pairs"};
    struct plan p = read_jobs(four, set, 3);
    assert_int_equal(p.nrun, 12);
    for (int k = 0; k < p.nrun; k++) {
        const struct run_spec *r = &p.run[k];
        if (r->job.number == 1) assert_int_equal(r->model.nbody, 16);
        if (r->job.number == 2) assert_int_equal(r->model.nbody, 20);
        assert_true(r->job.start == (r->job.number == 2 ? 2e-6 : r->job.number == 3 ? 5e-6 : 0));
    }
    plan_free(&p);
}

/* ---- places */

/* Processors of job `j` of a run; how many. */
static int places(const struct run_spec *r, int j, int *at)
{
    const struct placement_spec *p = &r->jobs->job[j]->machine.placement;
    const int n = r->jobs->job[j]->nrank;
    assert_int_equal(p->kind, PLACEMENT_LIST);
    assert_true(p->nlist >= n);
    for (int i = 0; i < n; i++) at[i] = p->list[i];
    return n;
}

/* Lists drawn at random: a plan is taken when no two ranks that there are have one processor;
 * places beyond the last rank of a list do not count. */
static void lists_that_meet_are_refused_and_no_others(void **state)
{
    (void)state;
    int met = 0, apart = 0;
    for (uint64_t seed = 0; seed < 300; seed++) {
        struct random random = random_make(seed, 0, 0);
        char text[2048] = "jobs:\n";
        bool taken[PROCESSORS] = {false}, meet = false, twice = false;
        for (int j = 0; j < 3; j++) {
            const int ranks = 1 + (int)random_below(&random, 4),
                      places = ranks + (int)random_below(&random, 2);
            bool own[PROCESSORS] = {false};
            snprintf(text + strlen(text), sizeof text - strlen(text),
                     "- {name: j%d, kernel: barrier, ranks: %d, placement: [", j, ranks);
            for (int i = 0; i < places; i++) {
                const int at = (int)random_below(&random, PROCESSORS);
                snprintf(text + strlen(text), sizeof text - strlen(text), "%s%d", i ? ", " : "",
                         at);
                twice = twice || own[at];
                if (i < ranks) meet = meet || (taken[at] && !own[at]);
                own[at] = true;
                if (i < ranks) taken[at] = true;
            }
            strcat(text, "]}\n");
        }
        if (twice) continue; /* two ranks of one job on a processor: another rule */
        char whole[4096];
        struct plan p;
        struct err e;
        const struct plan_options o = {.nset = 0};
        snprintf(whole, sizeof whole, TOP "%s", text);
        err_clear(&e);
        const bool read = plan_read(&p, scratch_write(&scratch, "s.yaml", whole), &o, &e);
        if (read == meet) fail_msg("%s\n%s", text, e.text);
        if (!read) assert_non_null(strstr(e.text, "overlap"));
        meet ? met++ : apart++;
        plan_free(&p);
    }
    assert_true(met > 30 && apart > 30);
}

static void lists_and_files_are_taken_as_they_are(void **state)
{
    (void)state;
    scratch_write(&scratch, "places.txt", "# two rows\n0-3, 8\n10 9 11 # the second\n");
    static const char text[] =
        "jobs:\n"
        "- {name: a, kernel: barrier, ranks: 8, placement: {file: places.txt}}\n"
        "- {name: b, kernel: barrier, ranks: 3, placement: [31, 5, 17]}\n";
    static const int of_a[] = {0, 1, 2, 3, 8, 10, 9, 11}, of_b[] = {31, 5, 17};
    struct plan p = read_jobs(text, NULL, 0);
    int at[PROCESSORS];
    assert_int_equal(places(&p.run[0], 0, at), 8);
    assert_memory_equal(at, of_a, sizeof of_a);
    assert_int_equal(places(&p.run[0], 1, at), 3);
    assert_memory_equal(at, of_b, sizeof of_b);
    plan_free(&p);
}

/* A place is several settings: what the file says besides gives way as a whole. */
static void a_place_of_the_command_line_replaces_all_of_the_files(void **state)
{
    (void)state;
    static const char text[] =
        "jobs:\n"
        "- {name: a, kernel: barrier, ranks: 4,\n"
        "   placement: {kind: random, seed: 9, spread: cyclic}}\n"
        "- {name: b, kernel: barrier, ranks: 2, placement: {list: [1, 0], spread: cyclic}}\n";
    static const char *const set[] = {"jobs.a.placement=contiguous", "jobs.b.placement=[30, 31]"};
    static const int of_b[] = {30, 31};
    struct plan p = read_jobs(text, NULL, 0), q = read_jobs(text, set, 2);
    int at[PROCESSORS];
    const struct placement_spec *file = &p.run[0].machine.placement,
                                *typed = &q.run[0].machine.placement;
    assert_true(file->kind == PLACEMENT_RANDOM && file->spread == SPREAD_CYCLIC);
    assert_int_equal(file->seed, 9);
    assert_true(typed->kind == PLACEMENT_LINEAR && typed->spread == SPREAD_BLOCK);
    assert_true(typed->seed != 9);
    assert_true(q.run[1].machine.placement.spread == SPREAD_BLOCK);
    assert_int_equal(places(&q.run[0], 1, at), 2);
    assert_memory_equal(at, of_b, sizeof of_b);
    plan_free(&p);
    plan_free(&q);
}

/* ---- what is none */

/* Each with the line of the scenario behind TOP, 0: a setting of the command line, and a part of
 * the message. */
static const struct {
    const char *text, *set;
    int line;
    const char *says;
} wrong[] = {
    {"jobs: many\n", NULL, 1, "expected a list of jobs"},
    {"jobs: []\n", NULL, 1, "expected a list of jobs"},
    {"jobs:\n- solver\n", NULL, 2, "expected a mapping"},
    {"jobs:\n- {kernel: barrier, ranks: 2}\n", NULL, 2, "a job without a name"},
    {"jobs:\n- {name: 1st, kernel: barrier, ranks: 2}\n", NULL, 2, "expected a letter"},
    {"jobs:\n- {name: a.b, kernel: barrier, ranks: 2}\n", NULL, 2, "expected a letter"},
    {"jobs:\n- {name: a b, kernel: barrier, ranks: 2}\n", NULL, 2, "expected a letter"},
    {"jobs:\n- {name: a23456789012345678901234567890123, kernel: barrier, ranks: 2}\n", NULL, 2,
     "at most 31"},
    {"jobs:\n- {name: background, kernel: barrier, ranks: 2}\n", NULL, 2, "choose another name"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2}\n- {name: a, kernel: barrier, ranks: 2}\n",
     NULL, 3, "two jobs are called 'a'; the first in line 7"},
    {"jobs:\n- {name: a, kernel: barrier, rank: 2}\n", NULL, 2, "did you mean 'ranks'"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2, machine.network.link.bandwidth: 1 GB/s}\n",
     NULL, 2, "which all jobs share"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2, start: -1 us}\n", NULL, 2, "start"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2, start: 3}\n", NULL, 2, "start"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2, placement: randon}\n", NULL, 2, "'random'"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2, placement: {kin: random}}\n", NULL, 2,
     "did you mean 'kind'"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 3, placement: [1, 2]}\n", NULL, 2,
     "has 3 ranks, but its list names 2 processors"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2, placement: [1, 32]}\n", NULL, 2,
     "processor 32 of rank 1; expected 0 to 31"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2, placement: [1, 2]}\n"
     "- {name: b, kernel: barrier, ranks: 2, placement: [4, 2]}\n",
     NULL, 3, "jobs 'a' and 'b' overlap: rank 1 of one and rank 1 of the other on processor 2"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 30}\n- {name: b, kernel: barrier, ranks: 3}\n",
     NULL, 3, "job 'b' has 3 ranks, but the jobs before it leave 2 of the 32 processors"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2}\ncombinations: none\n", NULL, 3,
     "combinations: 'none'"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2}\ncombinations: pair\n", NULL, 3,
     "did you mean 'pairs'?"},
    {"kernel: barrier\nranks: 2\ncombinations: all\n", NULL, 3, "no 'jobs' to combine"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2}\n", "jobs.b.n=3", 0, "no job is called 'b'"},
    {"jobs:\n- {name: solver, kernel: barrier, ranks: 2}\n", "jobs.solvr.n=3", 0,
     "did you mean 'solver'?"},
    {"jobs:\n- {name: a, kernel: barrier, ranks: 2}\n", "jobs.a.name=b", 0, "keeps its name"},
};

static void every_wrong_line_is_told_with_its_place(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct plan p;
        struct err e;
        char whole[4096];
        snprintf(whole, sizeof whole, TOP "%s", wrong[i].text);
        const char *path = scratch_write(&scratch, "s.yaml", whole);
        const struct plan_options o = {.nset = wrong[i].set != NULL, .set = &wrong[i].set};
        err_clear(&e);
        if (plan_read(&p, path, &o, &e)) fail_msg("taken: %s", wrong[i].text);
        if (strstr(e.text, wrong[i].says) == NULL)
            fail_msg("%s\nsays '%s', not '%s'", wrong[i].text, e.text, wrong[i].says);
        if (wrong[i].line > 0 && e.line != TOP_LINES + wrong[i].line)
            fail_msg("%s\nline %d: %s", wrong[i].text, e.line, e.text);
        plan_free(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(combinations_are_subsets_with_a_run_for_each_member),
        cmocka_unit_test(two_jobs_are_a_pair_and_all_at_once),
        cmocka_unit_test(settings_reach_one_job_alone),
        cmocka_unit_test(lists_that_meet_are_refused_and_no_others),
        cmocka_unit_test(lists_and_files_are_taken_as_they_are),
        cmocka_unit_test(a_place_of_the_command_line_replaces_all_of_the_files),
        cmocka_unit_test(every_wrong_line_is_told_with_its_place),
    };
    return cmocka_run_group_tests(tests, open_scratch, close_scratch);
}
