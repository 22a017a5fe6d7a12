/* cmd_lists.c - mimdsim scenarios and kernels: what there is. */
#include "app/verb.h"
#include "run/catalogue.h"

int cmd_scenarios(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "", "List the scenarios, each with its question.\n\nExample: mimdsim scenarios\n",
                 0, 0);
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

int cmd_kernels(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "", "List the kernels.\n\nExample: mimdsim kernels\n", 0, 0);
    struct catalogue k = catalogue_of_kernels();
    common_print_pairs(&c, k.n, k.name, k.title);
    return 0;
}
