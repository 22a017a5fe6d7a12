/* test_hosts.c - arrays between the processes of a job, over messages that are kept in memory here;
 * which MPI a process belongs to, and modules that are not there, too old, or do not start. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../support/last_words.h"
#include "../support/scratch.h"
#include "../support/thread_hosts.h"
#include "base/random.h"
#include "hosts/hosts_copy.h"

/* --- a job in memory: each process is asked in turn --- */

enum { PROCESSES = 5, MESSAGES = 64 };

struct message {
    int from, to, tag;
    size_t bytes;
    char *data;
};

static struct {
    int self; /* the process that calls */
    struct message box[MESSAGES];
    int n, sent, fail_at; /* fail_at: that many sends are good; -1: all */
    int looks, empty;     /* empty: so many looks find nothing first */
    bool broken_look, broken_receive;
    size_t largest;
} job;

static bool send(int to, int tag, const void *data, size_t bytes)
{
    if (job.sent++ == job.fail_at) return false;
    struct message *m = &job.box[job.n++];
    assert_true(job.n <= MESSAGES);
    *m = (struct message){job.self, to, tag, bytes, malloc(bytes + 1)};
    memcpy(m->data, data, bytes);
    if (bytes > job.largest) job.largest = bytes;
    return true;
}

/* The oldest that fits, as MPI has it. */
static struct message *find(int from, int tag)
{
    for (int i = 0; i < job.n; i++)
        if (job.box[i].to == job.self && job.box[i].from == from && job.box[i].tag == tag)
            return &job.box[i];
    return NULL;
}

static bool look(int from, int tag, bool wait, bool *there, struct hosts_message *m)
{
    assert_false(wait); /* who has nothing to do sleeps instead */
    if (job.broken_look) return false;
    *there = false;
    if (job.looks++ < job.empty) return true;
    const struct message *found = find(from, tag);
    if (!found) fail_msg("process %d waits for ever for %d", job.self, from);
    *m = (struct hosts_message){from, tag, found->bytes};
    *there = true;
    return true;
}

static bool receive(const struct hosts_message *m, void *data)
{
    struct message *found = find(m->from, m->tag);
    if (job.broken_receive) return false;
    memcpy(data, found->data, found->bytes);
    free(found->data);
    memmove(found, found + 1, sizeof *found * (size_t)(&job.box[--job.n] - found));
    return true;
}

static const struct hosts_calls calls = {
    .table = HOSTS_TABLE, .send = send, .look = look, .receive = receive};

static struct hosts process(int rank)
{
    job.self = rank;
    return (struct hosts){.rank = rank, .size = PROCESSES, .call = &calls};
}

static int begin(void **state)
{
    (void)state;
    memset(&job, 0, sizeof job);
    job.fail_at = -1;
    return 0;
}
static int end(void **state)
{
    (void)state;
    for (int i = 0; i < job.n; i++) free(job.box[i].data);
    return 0;
}

static void arrays_arrive_whole(void **state)
{
    static char out[5000], in[5001];
    struct random r = random_make(91, 0, 0);
    (void)state;
    for (int round = 0; round < 100; round++) {
        const size_t bytes = round < 3 ? (size_t)round : (size_t)random_below(&r, sizeof out);
        for (size_t i = 0; i < bytes; i++) out[i] = (char)random_u64(&r);
        memset(in, 77, sizeof in);
        job.looks = 0, job.empty = round % 4;
        struct hosts h = process(2);
        assert_true(hosts_copy_out(&h, 4, round, out, bytes));
        h = process(4);
        assert_true(hosts_copy_in(&h, 2, round, in, bytes));
        assert_memory_equal(in, out, bytes);
        assert_int_equal(in[bytes], 77);
        assert_int_equal(job.n, 0);
    }
    /* nothing needs no message */
    assert_int_equal(job.sent, 99);
}

/* What is larger than a piece goes in several, none larger than an int counts. */
static void large_arrays_go_in_pieces(void **state)
{
    const size_t piece = (size_t)1 << 26, bytes = piece + 3;
    char *out = malloc(bytes), *in = malloc(bytes);
    (void)state;
    memset(out, 1, bytes);
    memcpy(out + piece - 2, "abcde", 5);
    struct hosts h = process(0);
    assert_true(hosts_copy_out(&h, 1, 3, out, bytes));
    assert_int_equal(job.sent, 2);
    assert_int_equal(job.largest, piece);
    h = process(1);
    assert_true(hosts_copy_in(&h, 0, 3, in, bytes));
    assert_memory_equal(in, out, bytes);
    /* the second piece does not go */
    job.sent = 0, job.fail_at = 1;
    h = process(0);
    assert_false(hosts_copy_out(&h, 1, 3, out, bytes));
    assert_int_equal(job.n, 1);
    free(out);
    free(in);
}

static void what_does_not_fit_is_refused(void **state)
{
    char in[8] = {0};
    (void)state;
    struct hosts h = process(0);
    assert_true(hosts_copy_out(&h, 1, 3, "123456789", 9));
    h = process(1);
    assert_false(hosts_copy_in(&h, 0, 3, in, 8));
    assert_int_equal(in[0], 0);
    job.broken_look = true;
    assert_false(hosts_copy_in(&h, 0, 3, in, 8));
    job.broken_look = false, job.broken_receive = true;
    assert_false(hosts_copy_in(&h, 0, 3, in, 9));
    /* in pieces that do not add up: the rest of the second would lie behind the array */
    job.broken_receive = false;
    h = process(3);
    hosts_copy_out(&h, 1, 5, "12345", 5), hosts_copy_out(&h, 1, 5, "6789", 4);
    h = process(1);
    assert_false(hosts_copy_in(&h, 3, 5, in, 8));
    assert_memory_equal(in, "12345\0\0", 8);
}

static void all_are_told_by_the_first(void **state)
{
    (void)state;
    char word[8] = "spoken";
    struct hosts h = process(0);
    assert_true(hosts_tell(&h, 6, word, sizeof word));
    assert_int_equal(job.n, PROCESSES - 1);
    for (int i = 1; i < PROCESSES; i++) {
        char heard[8] = "";
        h = process(i);
        assert_true(hosts_tell(&h, 6, heard, sizeof heard));
        assert_string_equal(heard, "spoken");
    }
    /* one that has gone: the others hear it all the same */
    job.sent = 0, job.fail_at = 1;
    h = process(0);
    assert_false(hosts_tell(&h, 6, word, sizeof word));
    assert_int_equal(job.n, PROCESSES - 2);
    /* alone there is nobody to tell */
    h.size = 1;
    assert_true(hosts_tell(&h, 6, word, sizeof word));
}

static void sums_are_formed_on_the_first(void **state)
{
    (void)state;
    for (int n = 0; n <= 16; n += 8) {
        int64_t value[17];
        for (int i = 1; i < PROCESSES; i++) {
            for (int k = 0; k < n; k++) value[k] = ((int64_t)i << 40) - k;
            struct hosts h = process(i);
            assert_true(hosts_sum(&h, 8, value, n));
            for (int k = 0; k < n; k++) assert_int_equal(value[k], ((int64_t)i << 40) - k);
        }
        for (int k = 0; k <= 16; k++) value[k] = 7;
        struct hosts h = process(0);
        assert_true(hosts_sum(&h, 8, value, n));
        for (int k = 0; k < n; k++)
            assert_int_equal(value[k], 7 + ((int64_t)10 << 40) - (PROCESSES - 1) * k);
        assert_int_equal(value[16], n == 17 ? 0 : 7);
    }
    struct hosts h = process(0);
    job.broken_look = true;
    assert_false(hosts_sum(&h, 8, (int64_t[1]){0}, 1));
}

/* --- a job of threads: all at once --- */

struct agreeing {
    struct hosts hosts;
    pthread_t thread;
    const char *reason; /* NULL: this process can go on */
    bool agreed;
    struct err e;
};

static void *agree(void *context)
{
    struct agreeing *p = context;
    thread_hosts_join(p->hosts.rank);
    err_clear(&p->e);
    if (p->reason != NULL) err_set_at(&p->e, ERR_CONFIG, "t.yaml", 7, "%s", p->reason);
    p->agreed = hosts_agree(&p->hosts, 9, p->reason == NULL, &p->e);
    return NULL;
}

/* reason (4); what all must tell then, NULL: that they agree. */
static void all_agree(const char *const reason[4], const char *said)
{
    struct agreeing member[4];
    thread_hosts_begin();
    for (int i = 0; i < 4; i++) {
        member[i] = (struct agreeing){.hosts = {i, 4, &thread_hosts}, .reason = reason[i]};
        assert_int_equal(pthread_create(&member[i].thread, NULL, agree, &member[i]), 0);
    }
    for (int i = 0; i < 4; i++) pthread_join(member[i].thread, NULL);
    assert_int_equal(thread_hosts_end(), 0);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(member[i].agreed, said == NULL);
        assert_int_equal(member[i].e.kind, said == NULL ? ERR_NONE : ERR_CONFIG);
        if (said != NULL) assert_string_equal(member[i].e.text, said);
    }
    /* the place in a file stays where its reason is told */
    if (reason[0] != NULL) assert_int_equal(member[0].e.line, 7);
}

static void what_one_cannot_none_begins(void **state)
{
    (void)state;
    all_agree((const char *[]){NULL, NULL, NULL, NULL}, NULL);
    all_agree((const char *[]){NULL, NULL, "no room", NULL}, "process 2 of the job: no room");
    all_agree((const char *[]){NULL, "first", "second", NULL}, "process 1 of the job: first");
    all_agree((const char *[]){"same", "same", "same", "same"}, "same");
    char longest[sizeof((struct err *)0)->text], said[sizeof longest];
    memset(longest, 'x', sizeof longest);
    longest[sizeof longest - 1] = '\0';
    snprintf(said, sizeof said, "process 3 of the job: %.*s", (int)sizeof longest - 40, longest);
    all_agree((const char *[]){NULL, NULL, NULL, longest}, said);
}

/* A process that has gone: the first is told, and knows no more. */
static void who_does_not_answer_breaks_it(void **state)
{
    (void)state;
    struct err e;
    err_clear(&e);
    job.broken_look = true;
    const struct hosts h = process(0);
    assert_false(hosts_agree(&h, 9, true, &e));
    assert_int_equal(e.kind, ERR_INTERNAL);
    assert_string_equal(e.text, "a process of the job has ended, or does not answer");
}

static void sum_too_many(void)
{
    int64_t value[17] = {0};
    struct hosts h = process(1);
    hosts_sum(&h, 8, value, 17);
}

static void sums_have_their_limit(void **state)
{
    char words[300];
    (void)state;
    expect_abort(sum_too_many, words, sizeof words);
    assert_non_null(strstr(words, "CHECK("));
}

/* --- which MPI --- */

static const char *const marks[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"};

static void no_marks(void)
{
    for (int i = 0; i < 4; i++) unsetenv(marks[i]);
}

static void launchers_are_known_by_their_marks(void **state)
{
    (void)state;
    no_marks();
    assert_false(hosts_started());
    for (int i = 0; i < 4; i++) {
        setenv(marks[i], "0", 1);
        assert_true(hosts_started());
        no_marks();
    }
    setenv("PMI_RANKS", "1", 1);
    assert_false(hosts_started());
    unsetenv("PMI_RANKS");
}

/* A module that says these things, beside a copy of this program, which then opens it. */
static void open_beside(const char *module, const char *source, const char *mark, char *said,
                        size_t size)
{
    char folder[256], path[512], command[2048];
    const char *cc = getenv("CC") ? getenv("CC") : "cc";
    scratch_make(folder, sizeof folder);
    /* the program is known by the folder in which it lies */
    snprintf(command, sizeof command, "cp /proc/%d/exe %s/opens", (int)getpid(), folder);
    assert_int_equal(system(command), 0);
    if (source && source[0] == '!') {
        FILE *f = fopen(scratch_path(path, sizeof path, folder, module), "w");
        fputs(source, f);
        fclose(f);
    } else if (source) {
        FILE *f = fopen(scratch_path(path, sizeof path, folder, "m.c"), "w");
        fprintf(f, "#include \"hosts/hosts.h\"\n%s\n", source);
        fclose(f);
        snprintf(command, sizeof command, "%s -shared -fPIC -w -I%s/src -o %s/%s %s", cc,
                 getenv("MIMDSIM_SRCDIR") ? getenv("MIMDSIM_SRCDIR") : MIMDSIM_SRCDIR, folder,
                 module, path);
        if (system(command) != 0) {
            scratch_remove(folder);
            skip();
        }
    }
    snprintf(command, sizeof command, "%s%s %s/opens open", mark, mark[0] ? "=1" : "", folder);
    FILE *p = popen(command, "r");
    size_t n = fread(said, 1, size - 1, p);
    said[n] = '\0';
    pclose(p);
    scratch_remove(folder);
}

#define MODULE(table_, begin_)                                                                     \
    "static bool begin(int *r, int *s) { *r = 3, *s = 8; return " begin_ "; }\n"                   \
    "const struct hosts_calls mimdsim_hosts = {.table = " table_                                   \
    ", .library = \"Toy MPI\", .begin = begin};"

static void modules_are_found_or_missed_with_the_reason(void **state)
{
    static const struct {
        const char *module, *source, *mark, *said;
    } row[] = {
        {"mimdsim-hosts-openmpi.so", MODULE("HOSTS_TABLE", "true"), "PMIX_RANK",
         "good 3 of 8 Toy MPI"},
        {"mimdsim-hosts-mpich.so", MODULE("HOSTS_TABLE", "true"), "PMI_SIZE",
         "good 3 of 8 Toy MPI"},
        /* a job of one takes any */
        {"mimdsim-hosts-mpich.so", MODULE("HOSTS_TABLE", "true"), "", "good 3 of 8 Toy MPI"},
        {"mimdsim-hosts-openmpi.so", MODULE("HOSTS_TABLE", "false"), "PMIX_RANK",
         "71 Toy MPI does not start"},
        {"mimdsim-hosts-openmpi.so", MODULE("HOSTS_TABLE + 1", "true"), "PMIX_RANK",
         "belongs to another version of mimdsim"},
        {"mimdsim-hosts-openmpi.so", "int nothing;", "PMIX_RANK", "mimdsim_hosts"},
        {"mimdsim-hosts-openmpi.so", "! no module", "PMIX_RANK",
         "69 this mimdsim was built without Open MPI: "},
        /* that of the other MPI does not help */
        {"mimdsim-hosts-mpich.so", MODULE("HOSTS_TABLE", "true"), "PMIX_RANK",
         "69 this mimdsim was built without Open MPI; install its compiler (mpicc)"},
        {"mimdsim-hosts-mpich.so", NULL, "PMI_RANK",
         "69 this mimdsim was built without MPICH; install its compiler (mpicc)"},
        {"mimdsim-hosts-mpich.so", NULL, "", "69 this mimdsim was built without MPI; install"},
    };
    (void)state;
    no_marks();
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        char said[2000];
        open_beside(row[k].module, row[k].source, row[k].mark, said, sizeof said);
        if (!strstr(said, row[k].said)) fail_msg("row %d: '%s'", (int)k, said);
    }
}

/* As a program of its own: what hosts_open says. */
static int opens(void)
{
    struct hosts h;
    struct err e;
    err_clear(&e);
    if (hosts_open(&h, &e)) printf("good %d of %d %s\n", h.rank, h.size, h.call->library);
    else printf("%d %s\n", err_exit_status(e.kind), e.text);
    return 0;
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, begin, end)
int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "open") == 0) return opens();
    const struct CMUnitTest tests[] = {
        TEST(arrays_arrive_whole),
        TEST(large_arrays_go_in_pieces),
        TEST(what_does_not_fit_is_refused),
        TEST(all_are_told_by_the_first),
        TEST(sums_are_formed_on_the_first),
        TEST(sums_have_their_limit),
        TEST(what_one_cannot_none_begins),
        TEST(who_does_not_answer_breaks_it),
        TEST(launchers_are_known_by_their_marks),
        TEST(modules_are_found_or_missed_with_the_reason),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
