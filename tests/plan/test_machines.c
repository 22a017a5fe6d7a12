/* test_machines.c - machine files: inheritance, evidence, ranges, and that the machines that we
 * ship meet the published ping-pong times that they were made from. */
#include "scratch.h"

#include <math.h>

#include "plan/machine_file.h"
#include "spec/field.h"
#include "spec/spec_fields.h"
#include "../support/arena_fixture.h"

static int open_all(void **state) { return open_scratch(state) | make_arena(state); }
static int close_all(void **state) { return close_scratch(state) | drop_arena(state); }

static struct machine_spec machine(const char *name, struct origin **origin, int *norigin)
{
    struct machine_spec m;
    struct err e;
    err_clear(&e);
    if (!plan_machine(&m, name, NULL, arena, origin, norigin, &e))
        fail_msg("%s:%d: %s", e.file, e.line, e.text);
    return m;
}

static const struct origin *origin_of(const struct origin *list, int n, const char *key)
{
    for (int i = 0; i < n; i++)
        if (strcmp(list[i].key, key) == 0) return &list[i];
    fail_msg("no origin of %s", key);
    return NULL;
}

/* ---- the machines that we ship */

static void every_number_that_we_ship_has_class_and_source(void **state)
{
    (void)state;
    const char **stem, **title;
    struct err e;
    int n;
    err_clear(&e);
    assert_true(plan_list("machines", arena, &stem, &title, &n, &e));
    assert_true(n >= 20);
    for (int i = 0; i < n; i++) {
        struct origin *o;
        int no;
        struct machine_spec m = machine(stem[i], &o, &no);
        assert_string_equal(m.name, stem[i]);
        assert_true(strlen(title[i]) > 10 && machine_spec_processors(&m) >= 4);
        for (int k = 0; k < no; k++) {
            bool number =
                strchr("0123456789[", o[k].value[0]) != NULL && strcmp(o[k].key, "title") != 0;
            if (o[k].line == 0) {
                assert_string_equal(o[k].file, "default");
                continue;
            }
            if (number && (o[k].evidence[0] == '\0' || o[k].source[0] == '\0'))
                fail_msg("%s:%d: %s has no class or source", o[k].file, o[k].line, o[k].key);
        }
    }
}

static double wire_flits(const struct network_spec *w, double bytes)
{
    double packets = w->packet_bytes > 0 && bytes > (double)w->packet_bytes
                         ? ceil(bytes / (double)w->packet_bytes)
                         : 1;
    double last = bytes - (packets - 1) * (double)w->packet_bytes, flit = (double)w->flit_bytes;
    double full = ceil(((double)w->packet_bytes + (double)w->header_bytes) / flit);
    return (packets - 1) * full + fmax(1, ceil((last + (double)w->header_bytes) / flit));
}

static double one_of(double own, double whole) { return own < 0 ? whole : own; }

/* The same with segments: that which begins last at or below the size says everything, where it
 * says it. */
static double one_way_by_size_us(const struct machine_spec *m, int routers, double bytes,
                                 double per_byte)
{
    const struct network_spec *w = &m->network;
    const struct software_spec *s = &m->software;
    const struct software_segment *x = s->segment;
    while (x + 1 < s->segment + s->nsegment && bytes >= (double)x[1].from) x++;
    double trip = routers * w->hop_latency + w->end_latency;
    double t =
        one_of(x->send_overhead, s->send_overhead) + one_of(x->recv_overhead, s->recv_overhead);
    t += bytes * (one_of(x->send_copy, s->send_copy) + one_of(x->recv_copy, s->recv_copy));
    t += trip + one_of(x->latency, 0);
    t += (wire_flits(w, bytes) - 1) * (double)w->flit_bytes *
         fmax(per_byte, one_of(x->gap_per_byte, s->gap_per_byte));
    if (x->protocol != PROTOCOL_EAGER) /* requests are of the first segment */
        t += 2 * (trip + one_of(s->segment[0].latency, 0)) +
             one_of(x->rendezvous_latency, s->rendezvous_latency);
    return t * 1e6;
}

/* One way of a message over `routers` routers in an empty machine, by the fields' definitions alone
 * [us]. */
static double one_way_us(const struct machine_spec *m, int routers, double bytes)
{
    const struct network_spec *w = &m->network;
    const struct software_spec *s = &m->software;
    double in = w->injection_bandwidth > 0 ? w->injection_bandwidth : w->link_bandwidth;
    double out = w->ejection_bandwidth > 0 ? w->ejection_bandwidth : w->link_bandwidth;
    double per_byte = fmax(fmax(1 / in, 1 / out), s->gap_per_byte);
    bool is_short = bytes <= (double)s->short_bytes && s->short_bytes > 0;
    bool rendezvous = s->eager_bytes >= 0 && bytes > (double)s->eager_bytes;
    if (routers > 1) per_byte = fmax(per_byte, 1 / w->link_bandwidth);
    if (s->nsegment > 0)
        return one_way_by_size_us(m, routers, bytes,
                                  fmax(1 / fmin(in, out), routers > 1 ? 1 / w->link_bandwidth : 0));
    double trip = routers * w->hop_latency + w->end_latency;
    double t = s->send_overhead - (is_short ? s->short_saving : 0) + s->recv_overhead + trip;
    t += (wire_flits(w, bytes) - 1) * (double)w->flit_bytes * per_byte;
    t += bytes * (s->send_copy + s->recv_copy +
                  (is_short     ? s->short_copy
                   : rendezvous ? 0
                                : s->eager_copy));
    if (rendezvous) t += 2 * trip + s->rendezvous_latency;
    if (s->kernel_server)
        assert_true(s->kernel_time + bytes * s->kernel_per_byte <=
                    s->send_overhead + bytes * s->send_copy);
    return t * 1e6;
}

/* Published one-way times of validation.csv (P, PR) and start-up times and rates of machines.md,
 * used to calibrate. */
static const struct point {
    const char *machine;
    int routers;
    double bytes, us, tolerance;
} points[] = {
    {"t3e-300", 2, 0, 16, 0.02},
    {"t3e-300", 2, 288, 17.7, 0.1},
    {"t3e-300", 2, 1008, 21.9, 0.1},
    {"t3e-300", 2, 1e7, 1e7 / 170, 0.1},
    {"t3e-300-mpt", 2, 0, 5, 0.02},
    {"t3e-300-mpt", 2, 1e7, 1e7 / 298, 0.1},
    {"t3e-300-mpich", 2, 0, 20, 0.02},
    {"paragon", 2, 0, 29, 0.02},
    {"paragon", 2, 1e6, 29 + 1e6 / 154, 0.1},
    {"paragon-osf1-ad", 2, 0, 100, 0.02},
    {"paragon-osf1-ad", 2, 1e6, 100 + 1e6 / 32, 0.1},
    {"origin2000", 1, 0, 200, 0.02},
    {"origin2000", 1, 1008, 229, 0.1},
    {"origin2000", 1, 1e6, 1e6 / 35, 0.1},
    {"origin2000-shm", 1, 0, 12, 0.02},
    {"origin2000-shm", 1, 1e6, 1e4, 0.1},
    {"quad-ppro", 2, 0, 210, 0.02},
    {"quad-ppro", 2, 1008, 282, 0.1},
    {"quad-ppro", 2, 1e6, 1e6 / 14, 0.1},
    {"quad-ppro-shm", 2, 0, 30, 0.02},
    {"quad-ppro-shm", 2, 1e6, 25000, 0.1},
    {"fugaku", 2, 0, 1.05, 0.1},
    {"fugaku", 2, 64, 1.31, 0.1},
    {"fugaku", 2, 1024, 1.98, 0.1},
    {"fugaku", 2, 8192, 3.9, 0.1},
    {"fugaku", 2, 16384, 7.27, 0.1},
    {"fugaku", 2, 32768, 11.5, 0.1},
    {"fugaku", 2, 65536, 17.1, 0.1},
    {"fugaku", 2, 1048576, 172, 0.1},
    {"fugaku", 2, 4194304, 668, 0.1},
    {"slingshot-11", 1, 1, 3, 0.1},
    {"slingshot-11", 1, 1024, 4.47, 0.1},
    {"slingshot-11", 1, 8192, 7.92, 0.1},
    {"slingshot-11", 1, 65536, 10.92, 0.1},
    {"slingshot-11", 1, 1048576, 51.73, 0.1},
    {"slingshot-11", 1, 4194304, 181.46, 0.1},
    {"aries", 1, 0, 1.11, 0.1},
    {"aries", 1, 1024, 1.39, 0.1},
    {"aries", 1, 8192, 4.21, 0.1},
    {"aries", 1, 32768, 6.73, 0.1},
    {"aries", 1, 65536, 10.07, 0.1},
    {"aries", 1, 1048576, 109.28, 0.1},
    {"aries", 1, 4194304, 431.85, 0.1},
    {"infiniband-hdr", 1, 0, 1.57, 0.1},
    {"infiniband-hdr", 1, 1024, 2.52, 0.1},
    {"infiniband-hdr", 1, 16384, 5.24, 0.1},
    {"infiniband-hdr", 1, 1048576, 50, 0.1},
    {"infiniband-hdr", 1, 4194304, 177.34, 0.1},
    {"infiniband-ndr", 1, 0, 1.1, 0.02},
    {"infiniband-ndr", 1, 4e6, 4e6 / 48e3, 0.1},
    {"bluegene-q", 2, 0, 2.2, 0.02},
    {"bluegene-q", 2, 1e6, 1e6 / 1770, 0.1},
    {"smp-node", 1, 0, 0.51, 0.1},
    {"smp-node", 1, 4096, 1.1, 0.1},
    {"smp-node", 1, 65536, 10.81, 0.1},
    {"smp-node", 1, 1048576, 130.65, 0.1},
    {"ethernet-10g", 1, 0, 20, 0.02},
    {"ethernet-10g", 1, 1e7, 1e7 / 1150, 0.1},
    {"ethernet-1g", 1, 0, 24.5, 0.1},
    {"ethernet-1g", 1, 1024, 48, 0.1},
    {"ethernet-1g", 1, 65536, 741.72, 0.1},
    {"ethernet-1g", 1, 1048576, 9184.2, 0.1},
    {"ipsc-860", 2, 0, 65, 0.02},
    {"ipsc-860", 2, 1e6, 113 + 1e6 / 3, 0.1},
    {"ncube-2", 2, 0, 154, 0.02},
    {"ncube-2", 2, 1e6, 154 + 1e6 / 1.7, 0.1},
    {"cm-5", 1, 0, 95, 0.02},
    {"cm-5", 1, 1e6, 95 + 1e6 / 9, 0.1},
    {"meiko-cs-2", 1, 0, 83, 0.02},
    {"meiko-cs-2", 1, 1e6, 83 + 1e6 / 43, 0.1},
    {"loggp-example", 1, 101, 10, 1e-9},
};

static void machines_meet_the_points_that_they_were_made_from(void **state)
{
    (void)state;
    int bad = 0;
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        const struct point *p = &points[i];
        struct machine_spec m = machine(p->machine, NULL, NULL);
        double t = one_way_us(&m, p->routers, p->bytes), error = t / p->us - 1;
        if (fabs(error) <= p->tolerance) continue;
        print_error("%s, %.0f B: %.4g us, published %.4g us: %+.1f %%\n", p->machine, p->bytes, t,
                    p->us, 100 * error);
        bad++;
    }
    assert_int_equal(bad, 0);
}

static void the_paper_s_machines_have_their_sizes(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int processors;
    } sizes[] = {{"t3e-300", 128},     {"t3e-300-mpich", 128}, {"paragon", 256},
                 {"origin2000", 16},   {"origin2000-shm", 16}, {"quad-ppro", 4},
                 {"quad-ppro-shm", 4}, {"fugaku", 158976},     {"slingshot-11", 37888},
                 {"cm-5", 256}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct machine_spec m = machine(sizes[i].name, NULL, NULL);
        assert_int_equal(machine_spec_processors(&m), sizes[i].processors);
    }
}

/* ---- files */

#define SMALL                                                                                      \
    "schema_version: 1\ntitle: small\ntopology: {family: torus, dims: [4]}\n"                      \
    "node: {flop_rate: 1 Mflop/s, clock: 1 MHz}\nnetwork:\n  link:\n    bandwidth: "

static void a_variant_changes_what_it_names_and_inherits_the_rest(void **state)
{
    (void)state;
    struct origin *base, *variant;
    int nbase, nvariant, changed = 0;
    machine("t3e-300", &base, &nbase);
    machine("t3e-300-mpt", &variant, &nvariant);
    assert_int_equal(nbase, nvariant);
    for (int i = 0; i < nbase; i++) {
        bool own = strstr(variant[i].file, "t3e-300-mpt.yaml") != NULL;
        assert_string_equal(base[i].key, variant[i].key);
        if (!own && strcmp(base[i].key, "name") != 0)
            assert_string_equal(base[i].value, variant[i].value);
        changed += own;
    }
    assert_int_equal(changed, 10);
    const struct origin *rate = origin_of(variant, nvariant, "node.flop_rate");
    assert_string_equal(rate->value, "55 Mflop/s");
    assert_string_equal(rate->evidence, "D/E");
    assert_true(rate->min == 35e6 && rate->max == 100e6 && rate->line > 5);
    assert_true(strlen(rate->source) > 20);
    const struct origin *limit = origin_of(variant, nvariant, "software.eager.limit");
    assert_true(limit->min == 2048 && limit->max == 8192);
    const struct origin *put = origin_of(variant, nvariant, "published.shmem_put");
    assert_string_equal(put->value, "2.5 us");
    assert_string_equal(origin_of(variant, nvariant, "software.gap_per_byte")->file, "default");
}

static void a_machine_beside_its_base_finds_it(void **state)
{
    (void)state;
    struct origin *o;
    int n;
    scratch_write(&scratch, "small.yaml",
                  SMALL "{value: 2 GB/s, class: P, min: 1 GB/s, max: 3 GB/s}\n");
    const char *path = scratch_write(
        &scratch, "mine.yaml", "schema_version: 1\nbase: small\nnetwork.link.bandwidth: 5 GB/s\n");
    struct machine_spec m = machine(path, &o, &n);
    assert_true(m.network.link_bandwidth == 5e9);
    assert_string_equal(m.name, "mine");
    assert_string_equal(m.title, "small");
    const struct origin *rate = origin_of(o, n, "network.link.bandwidth");
    assert_string_equal(rate->file, path);
    assert_int_equal(rate->line, 3);
    assert_true(rate->min == 0 && rate->max == 0 && rate->evidence[0] == '\0');
    assert_int_equal(origin_of(o, n, "topology.dims")->line, 3);
}

static void users_keep_machines_in_their_own_folder(void **state)
{
    (void)state;
    char dir[128];
    struct err e;
    const char **stem, **title;
    int n, found = 0;
    snprintf(dir, sizeof dir, "mkdir -p %s/mimdsim/machines", scratch.dir);
    assert_int_equal(system(dir), 0);
    scratch_write(&scratch, "mimdsim/machines/homemade.yaml", SMALL "1 GB/s\n");
    assert_string_equal(machine("homemade", NULL, NULL).title, "small");
    err_clear(&e);
    assert_true(plan_list("machines", arena, &stem, &title, &n, &e));
    for (int i = 0; i < n; i++) found += strcmp(stem[i], "homemade") == 0;
    assert_int_equal(found, 1);
}

static void wrong_machines_are_refused_with_line_and_reason(void **state)
{
    (void)state;
    static const struct {
        const char *text, *expected;
        int line;
        enum err_kind kind;
    } bad[] = {
        {"title: x\n", "schema_version is missing", 1, ERR_DATA},
        {"schema_version: 1\ntitle: x\n", "topology.family is missing", 0, ERR_DATA},
        {SMALL "480\n", "network.link.bandwidth: '480': no unit", 7, ERR_DATA},
        {SMALL "{value: 480 MB/s, clas: P}\n", "unknown key 'clas'", 7, ERR_DATA},
        {SMALL "{value: 480 MB/s, class: X}\n", "class 'X'", 7, ERR_DATA},
        {SMALL "{value: 480 MB/s, class: P/}\n", "class 'P/'", 7, ERR_DATA},
        {SMALL "{value: 480 MB/s, min: 1}\n", "min '1': no unit", 7, ERR_DATA},
        {SMALL "{value: 480 MB/s, min: 1 GB/s}\n", "outside its own range", 7, ERR_DATA},
        {SMALL "{value: 480 MB/s, max: [1]}\n", "'max' must be a single value", 7, ERR_DATA},
        {SMALL "{class: P}\n", "expected a value", 7, ERR_DATA},
        {SMALL "1 GB/s\n    bandwidht: 3\n", "unknown key 'bandwidht' in 'machine.network.link'",
         8, ERR_DATA},
        {SMALL "1 GB/s\nnetwork.link.bandwidth: 1 GB/s\n", "duplicate key 'network.link.bandwidth'",
         8, ERR_DATA},
        {SMALL "1 GB/s\n  level: {value: link, min: loggp}\n", "only numbers have a range",
         8, ERR_DATA},
        {SMALL "1 GB/s\nkernel: dynamics\n", "unknown key 'kernel'", 8, ERR_DATA},
        {SMALL "1 GB/s\nnmae: x\n", "unknown key", 8, ERR_DATA},
        {SMALL "1 GB/s\nname: [x, y]\n", "name: expected one line of text", 8, ERR_DATA},
        {SMALL "1 GB/s\nbase: nowhere\n", "base: no machine 'nowhere'", 8, ERR_NO_INPUT},
        {SMALL "1 GB/s\npublished: [a]\n", "published: expected", 8, ERR_DATA},
        {SMALL "1 GB/s\ntopology.family: fat-tree\n", "duplicate key 'topology.family'",
         8, ERR_DATA},
        {"schema_version: 1\nbase: t3e-300\ntopology: {family: dragonfly}\n",
         "topology.dims has 3 numbers", 0,
         ERR_CONFIG},
        {"schema_version: 1\nbase: t3e-300\ntopology: {family: graph, dims: [3], links: [[0, "
         "3]]}\n",
         "names router 3; there are 3", 3, ERR_CONFIG},
        {"schema_version: 1\nbase: t3e-300\ntopology: {family: graph, dims: [3]}\n",
         "needs topology.links", 3,
         ERR_CONFIG},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct machine_spec m;
        struct err e;
        const char *path = scratch_write(&scratch, "bad.yaml", bad[i].text);
        err_clear(&e);
        if (plan_machine(&m, path, NULL, arena, NULL, NULL, &e))
            fail_msg("accepted:\n%s", bad[i].text);
        if (strstr(e.text, bad[i].expected) == NULL) fail_msg("%s\ngives: %s", bad[i].text, e.text);
        assert_int_equal(e.kind, bad[i].kind);
        if (bad[i].line != 0) assert_int_equal(e.line, bad[i].line);
    }
}

static void machines_that_build_on_each_other_are_refused(void **state)
{
    (void)state;
    struct machine_spec m;
    struct err e;
    scratch_write(&scratch, "ring-a.yaml", "schema_version: 1\nbase: ring-b\n");
    const char *path = scratch_write(&scratch, "ring-b.yaml", "schema_version: 1\nbase: ring-a\n");
    err_clear(&e);
    assert_false(plan_machine(&m, path, NULL, arena, NULL, NULL, &e));
    assert_non_null(strstr(e.text, "is based on itself"));
}

static void settings_of_a_machine_come_last(void **state)
{
    (void)state;
    const char *const set[] = {"machine.network.link.bandwidth=960 MB/s", "level=loggp"};
    struct plan_options o = {.nset = 2, .set = set};
    struct machine_spec m;
    struct origin *origin;
    struct err e;
    int n;
    err_clear(&e);
    assert_true(plan_machine(&m, "t3e-300", &o, arena, &origin, &n, &e));
    assert_true(m.network.link_bandwidth == 960e6 && m.network.level == LEVEL_LOGGP);
    assert_string_equal(origin_of(origin, n, "network.link.bandwidth")->file, "--set");
    static const char *const wrong[] = {"kernel.solver=cr", "machine.network.link.bandwidth=1",
                                        "machine", "n=3",
                                        "machine.topology.dims=[4096, 4096, 4096]"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        o = (struct plan_options){.nset = 1, .set = &wrong[i]};
        err_clear(&e);
        if (plan_machine(&m, "t3e-300", &o, arena, NULL, NULL, &e))
            fail_msg("--set %s is accepted", wrong[i]);
    }
}

static void check_tells_machines_from_scenarios(void **state)
{
    (void)state;
    struct err e;
    err_clear(&e);
    assert_true(plan_check_file(MIMDSIM_SRCDIR "/machines/t3e-300.yaml", NULL, &e));
    assert_true(plan_check_file(MIMDSIM_SRCDIR "/machines/t3e-300-mpt.yaml", NULL, &e));
    assert_true(plan_check_file(MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", NULL, &e));
    assert_false(plan_check_file(
        scratch_write(&scratch, "half.yaml", "schema_version: 1\ntitle: x\n"), NULL, &e));
    assert_non_null(strstr(e.text, "topology.family is missing"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_number_that_we_ship_has_class_and_source),
        cmocka_unit_test(machines_meet_the_points_that_they_were_made_from),
        cmocka_unit_test(the_paper_s_machines_have_their_sizes),
        cmocka_unit_test(a_variant_changes_what_it_names_and_inherits_the_rest),
        cmocka_unit_test(a_machine_beside_its_base_finds_it),
        cmocka_unit_test(users_keep_machines_in_their_own_folder),
        cmocka_unit_test(wrong_machines_are_refused_with_line_and_reason),
        cmocka_unit_test(machines_that_build_on_each_other_are_refused),
        cmocka_unit_test(settings_of_a_machine_come_last),
        cmocka_unit_test(check_tells_machines_from_scenarios),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
