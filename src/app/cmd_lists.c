/* cmd_lists.c - mimdsim scenarios and kernels: what there is. */
#include "app/verb.h"
#include "base/json.h"
#include "run/catalogue.h"

static void print_pairs(const struct common *c, int n, const char *const *name, const char *const *title)
{
    struct json j = json_make(stdout);
    if (c->json) json_array(&j);
    for (int i = 0; i < n; i++) {
        if (!c->json) {
            printf("%-20s %s\n", name[i], title[i]);
            continue;
        }
        json_object(&j);
        json_key(&j, "name");
        json_text(&j, name[i]);
        json_key(&j, "title");
        json_text(&j, title[i]);
        json_end(&j);
    }
    if (c->json) {
        json_end(&j);
        json_finish(&j);
    }
}

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
    if (plan_list("scenarios", a, &stem, &title, &n, &e)) print_pairs(&c, n, stem, title);
    else status = common_fail(&c, &e);
    arena_destroy(a);
    return status;
}

int cmd_kernels(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "", "List the kernels.\n\nExample: mimdsim kernels\n", 0, 0);
    struct catalogue k = catalogue_of_kernels();
    print_pairs(&c, k.n, k.name, k.title);
    return 0;
}
