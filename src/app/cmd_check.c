/* cmd_check.c - mimdsim check: validate scenario and machine files without running. */
#include "app/verb.h"

static const char doc[] = "Validate scenario and machine files without running anything.\n\n"
                          "Example: mimdsim check scenarios/speedup-t3e.yaml machines/t3e-300.yaml\n\v"
                          "Every file is looked at; the exit status is that of the first one that is wrong.";

int cmd_check(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "FILE...", doc, 1, 64);
    int status = 0;
    for (int i = 0; i < c.narg; i++) {
        struct err e;
        err_clear(&e);
        if (plan_check_file(c.arg[i], &e)) {
            if (!c.quiet && !c.json) printf("%s: ok\n", c.arg[i]);
            continue;
        }
        int failed = common_fail(&c, &e);
        if (!status) status = failed;
    }
    return status;
}
