/* netdata.h - reads the reference data of tests/data/net: a small JSON reader, machines and message lists of cases. */
#ifndef TESTS_NETDATA_H
#define TESTS_NETDATA_H

#include "machine/topology.h"
#include "net/traffic.h"

enum json_kind { JSON_NULL, JSON_BOOL, JSON_NUMBER, JSON_TEXT, JSON_LIST, JSON_OBJECT };

struct json_value {
    enum json_kind kind;
    double number;
    const char *text;             /* of a text, or the key of a member is in `key` */
    const char *key;
    int count;                    /* of items or members */
    struct json_value *item;
};

/* json_load: the file tests/data/net/`name`, in a; fails the test when it is not there or not JSON. */
const struct json_value *json_load(struct arena *a, const char *name);

/* json_get: member `key` of an object, NULL when it has none. */
const struct json_value *json_get(const struct json_value *v, const char *key);

/* json_int, json_str: a member that must be there. */
int64_t json_int_of(const struct json_value *v, const char *key);
const char *json_str_of(const struct json_value *v, const char *key);

/* A case: its machine with one cycle = 1 ns, its topology and messages. */
struct netcase {
    struct machine_spec machine;
    struct topology *topology;
    struct traffic traffic;
    const struct json_value *completion; /* NULL: not given */
};

enum { NETCASE_FLIT_BYTES = 16, NETCASE_CYCLE = 1000 };

/* netcase_machine: `topology` as named in the data ("mesh8x8", "torus4x4x8", "hcube7", "ring4"). */
void netcase_machine(struct netcase *c, struct arena *a, const char *topology, int channels, int buffer, int tie,
                     enum network_level level);

/* netcase_read: a case of makespan.json, makespan_sensitivity.json, collectives.json or hand_cases.json. */
void netcase_read(struct netcase *c, struct arena *a, const struct json_value *v, enum network_level level);

/* netcase_run: replay; fails the test on an error. Arrivals [cycles] into out[nmessage], -1 for those that never came.
 * Returns the makespan [cycles]; *r may be NULL. */
int64_t netcase_run(const struct netcase *c, int64_t *out, struct traffic_result *r);

#endif
