/* machine_idle.h - settings of a machine that have no effect in a given run.
 *
 * The table of fields (machine_spec.c) names for each setting the function that answers for it. */
#ifndef SPEC_MACHINE_IDLE_H
#define SPEC_MACHINE_IDLE_H

#include <stdbool.h>

struct run_spec;

/* machine_idle_*: why the settings that name the function cannot act in run r, as a clause ("only a
 * hypercube has Xpress links"), a constant text; NULL when they act. */
const char *machine_idle_with_own_nodes(const struct run_spec *r);
const char *machine_idle_without_links(const struct run_spec *r);
const char *machine_idle_unless_ring(const struct run_spec *r);
const char *machine_idle_unless_dragonfly(const struct run_spec *r);
const char *machine_idle_unless_hypercube(const struct run_spec *r);
const char *machine_idle_unless_bundles(const struct run_spec *r);
const char *machine_idle_unless_levels(const struct run_spec *r);
const char *machine_idle_unless_express(const struct run_spec *r);
const char *machine_idle_unless_twisted(const struct run_spec *r);
const char *machine_idle_unless_seeded(const struct run_spec *r);
const char *machine_idle_unless_graph(const struct run_spec *r);
const char *machine_idle_unless_tolerance(const struct run_spec *r);
const char *machine_idle_above_packets(const struct run_spec *r);
const char *machine_idle_unless_routed(const struct run_spec *r);
const char *machine_idle_without_allocators(const struct run_spec *r);
const char *machine_idle_unless_server(const struct run_spec *r);
const char *machine_idle_with_segments(const struct run_spec *r);
const char *machine_idle_send_overhead(const struct run_spec *r);
const char *machine_idle_send_copy(const struct run_spec *r);
const char *machine_idle_recv_overhead(const struct run_spec *r);
const char *machine_idle_recv_copy(const struct run_spec *r);
const char *machine_idle_gap(const struct run_spec *r);
const char *machine_idle_gap_per_byte(const struct run_spec *r);
const char *machine_idle_unless_eager_limit(const struct run_spec *r);
const char *machine_idle_unless_short(const struct run_spec *r);
const char *machine_idle_unless_hardware_barrier(const struct run_spec *r);
const char *machine_idle_unless_several(const struct run_spec *r);
const char *machine_idle_unless_shared_node(const struct run_spec *r);
const char *machine_idle_unless_random(const struct run_spec *r);
const char *machine_idle_unless_list(const struct run_spec *r);
const char *machine_idle_at_loggp(const struct run_spec *r);
const char *machine_idle_unless_background(const struct run_spec *r);
const char *machine_idle_in_runs(const struct run_spec *r);
const char *machine_idle_in_programs(const struct run_spec *r);
const char *machine_idle_without_code(const struct run_spec *r);
const char *machine_idle_without_collectives(const struct run_spec *r);
const char *machine_idle_unless_roofline(const struct run_spec *r);
const char *machine_idle_without_hardware(const struct run_spec *r);

/* machine_dormant_unless_roofline: whether the struct machine_spec at `machine` knows no caches
 * (field.h). */
bool machine_dormant_unless_roofline(const void *machine);

#endif
