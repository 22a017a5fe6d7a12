/* bench_dynamics.c - time of RNEA, ABA and CRBA per call and per body, and of ABA of several states
 * at once.
 *
 * Chains of revolute joints with twisted axes, double precision, one core; the least of many
 * repetitions. */
#include <stdio.h>
#include <stdlib.h>

#include "base/arena.h"
#include "base/check.h"
#include "base/progress.h"
#include "dynamics/dynamics.h"
#include "dynamics/lanes_type.h"
#include "dynamics/system.h"

struct scene {
    struct arena *arena;
    struct dynamics *dynamics;
    struct state *state;
    double *out;
    const struct lanes_type *lanes; /* of call_lanes */
    struct lanes *held;
    double *q, *u, *ud; /* its states and answers, one in each lane */
};

static struct scene scene_make(int n, enum model_joint joint)
{
    struct scene s = {.arena = arena_create()};
    struct model_spec spec = {.generator = MODEL_SERIAL_CHAIN,
                              .nbody = n,
                              .joint = joint,
                              .length = 1,
                              .radius = 0.05,
                              .mass = 1,
                              .mass_ratio = 1,
                              .axes = AXES_TWISTED,
                              .pose = POSE_COILED,
                              .inertia = INERTIA_RANDOM,
                              .rate = 1,
                              .torque = 1,
                              .gravity = {0, 0, -9.81},
                              .seed = 1};
    struct err e;
    err_clear(&e);
    struct model *m = model_build(&spec, s.arena, &e);
    CHECK(m);
    system_prepare(m);
    s.state = state_make(m, &spec, s.arena);
    s.dynamics = dynamics_take(m, s.arena);
    s.out = TAKE(s.arena, (size_t)n * (size_t)n + 1, double);
    return s;
}

static void call_rnea(struct scene *s)
{
    rnea(s->dynamics, s->state->q, s->state->qd, s->state->qdd, s->out, NULL);
}

static void call_aba(struct scene *s)
{
    aba(s->dynamics, s->state->q, s->state->qd, s->state->tau, s->out, NULL);
}

static void call_crba(struct scene *s) { crba(s->dynamics, s->state->q, s->out, NULL); }

static void call_lanes(struct scene *s)
{
    s->lanes->forward(s->held, s->q, s->u, s->state->tau, s->ud);
}

/* The same state in all lanes: how long they take does not depend on it. */
static void lanes_make(struct scene *s, const struct lanes_type *lanes)
{
    const struct model *m = s->dynamics->model;
    const int width = lanes->width;
    s->lanes = lanes;
    s->held = lanes->hold(m, s->state, s->arena);
    s->q = TAKE(s->arena, m->nq * width, double), s->u = TAKE(s->arena, m->nu * width, double);
    s->ud = TAKE(s->arena, m->nu * width, double);
    for (int i = 0; i < m->nq * width; i++) s->q[i] = s->state->q[i / width];
    for (int i = 0; i < m->nu * width; i++) s->u[i] = s->state->qd[i / width];
}

/* Seconds of the fastest of several batches, per call. */
static double seconds_of(void (*call)(struct scene *), struct scene *s)
{
    int calls = 1;
    double best = 1e9;
    for (int rep = 0; rep < 60; rep++) {
        double start = host_seconds();
        for (int k = 0; k < calls; k++) call(s);
        double t = host_seconds() - start;
        if (t < 1e-3 && rep < 20) {
            calls *= 2;
            continue;
        }
        best = t / calls < best ? t / calls : best;
    }
    return best;
}

/* Articulated bodies one state after the other and several at once, on revolute joints (a shorter
 * source) and on joints of all kinds. */
static void print_lanes(void)
{
    static const int size[] = {7, 64};
    printf("\n%-6s %6s %6s %12s %12s %8s\n", "ABA of", "n", "lanes", "us/state", "ns/body",
           "ratio");
    for (int width = 4; width <= 8; width += 4)
        for (int k = 0; k < 4 && lanes_type_of(width); k++) {
            const bool mixed = k >= 2;
            struct scene s = scene_make(size[k % 2], mixed ? JOINT_MIXED : JOINT_REVOLUTE);
            lanes_make(&s, lanes_type_of(width));
            double one = 1e9, each = 1e9;
            for (int turn = 0; turn < 5; turn++) {
                const double a = seconds_of(call_aba, &s), b = seconds_of(call_lanes, &s) / width;
                one = a < one ? a : one, each = b < each ? b : each;
            }
            printf("%-6s %6d %6d %12.3f %12.1f %8.2f\n", mixed ? "mixed" : "turns", size[k % 2],
                   width, each * 1e6, each * 1e9 / size[k % 2], one / each);
            arena_destroy(s.arena);
        }
}

int main(void)
{
    static const struct {
        const char *name;
        void (*call)(struct scene *);
    } row[] = {{"RNEA", call_rnea}, {"ABA", call_aba}, {"CRBA", call_crba}};
    static const int size[] = {7, 16, 64, 128, 1024};
    printf("%-6s %6s %12s %12s\n", "", "n", "us/call", "ns/body");
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 5; k++) {
            struct scene s = scene_make(size[k], JOINT_REVOLUTE);
            double t = seconds_of(row[r].call, &s);
            printf("%-6s %6d %12.3f %12.1f\n", row[r].name, size[k], t * 1e6, t * 1e9 / size[k]);
            arena_destroy(s.arena);
        }
    print_lanes();
    return 0;
}
