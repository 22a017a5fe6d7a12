/* cmd_check.c - mimdsim check: validate scenario and machine files without running. */
#include "app/verb.h"
#include <string.h>

#include "base/json.h"
#include "study/model_file.h"
#include "study/probe.h"

static const char doc[] =
    "Validate scenario, machine, robot (.urdf) and reference vector (.json) files without running "
    "anything.\n\n"
    "Example: mimdsim check scenarios/speedup-t3e.yaml machines/t3e-300.yaml\n"
    "\vAll files are checked; the exit status is that of the first invalid one. "
    "A warning on standard error names a machine on which a message is faster than one that is a "
    "byte smaller "
    "(where a segment of its message software begins).";

/* Steps of the message software that go down: they may be meant, as where a protocol is switched too late. */
static void tell_steps_down(const char *file)
{
    struct machine_spec m;
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    struct err e;
    struct arena *a = arena_create();
    struct text path = {0};
    err_clear(&e);
    text_add(&path, "%s%s", strchr(file, '/') == NULL ? "./" : "", file);
    const int n = plan_machine(&m, path.s, NULL, a, NULL, NULL, &e) ? software_segments(&m.software, list) : 0;
    for (int i = 1; i < n; i++) {
        double below, at, size = (double)list[i].from;
        if (!probe_measure(&m, PROBE_ONE_WAY, size - 1, 0, &below, &e) ||
            !probe_measure(&m, PROBE_ONE_WAY, size, 0, &at, &e))
            break;
        if (at < below)
            fprintf(stderr, "%s: a message of %.0f B takes %.4g us, one of %.0f B only %.4g us: is this "
                            "intended?\n", file,
                    size - 1, below * 1e6, size, at * 1e6);
    }
    text_free(&path);
    arena_destroy(a);
}

int cmd_check(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "FILE...", doc, 1, 64);
    struct plan_options o = common_plan(&c);
    struct json j = json_make(stdout);
    int status = 0;
    if (c.json) json_array(&j);
    for (int i = 0; i < c.narg; i++) {
        struct err e;
        err_clear(&e);
        bool fine = model_file_is(c.arg[i]) ? model_file_check(c.arg[i], c.quiet ? NULL : stderr, &e)
                                            : plan_check_file(c.arg[i], &o, &e);
        if (c.json) common_error_json(&j, c.arg[i], &e);
        else if (fine && !c.quiet) printf("%s: ok\n", c.arg[i]);
        if (!fine) err_print(&e);
        if (fine && !c.quiet && !model_file_is(c.arg[i])) tell_steps_down(c.arg[i]);
        if (!status) status = err_exit_status(e.kind);
    }
    if (c.json) {
        json_end(&j);
        json_finish(&j);
    }
    return status;
}
