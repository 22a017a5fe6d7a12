/* cmd_check.c - mimdsim check: validate scenario and machine files without running. */
#include "app/verb.h"
#include "base/json.h"
#include "run/model_file.h"

static const char doc[] =
    "Validate scenario, machine, robot (.urdf) and reference vector (.json) files, running nothing.\n\n"
    "Example: mimdsim check scenarios/speedup-t3e.yaml machines/t3e-300.yaml\n\v"
    "Every file is looked at; the exit status is that of the first one that is wrong.";

/* One entry of the document: the file, and what is wrong with it. */
static void print_verdict(struct json *j, const char *file, const struct err *e)
{
    bool fine = e->kind == ERR_NONE;
    json_object(j);
    json_key(j, "exit_status");
    json_int(j, err_exit_status(e->kind));
    json_key(j, "file");
    json_text(j, file);
    json_key(j, "kind");
    json_text(j, err_word(e->kind));
    json_key(j, "line");
    json_int(j, e->line);
    json_key(j, "text");
    json_text(j, fine ? "" : e->text);
    json_end(j);
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
        if (c.json) print_verdict(&j, c.arg[i], &e);
        else if (fine && !c.quiet) printf("%s: ok\n", c.arg[i]);
        if (!fine) err_print(&e);
        if (!status) status = err_exit_status(e.kind);
    }
    if (c.json) {
        json_end(&j);
        json_finish(&j);
    }
    return status;
}
