/* flag.c - see flag.h.
 *
 * argp knows the options that all verbs share; an option of one verb is taken out before. "--"
 * ends options here as it does there. */
#include "app/flag.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "spec/run_spec.h"

/* argv keeps its NULL at the end. */
static void drop(int *argc, char **argv, int at, int n)
{
    for (int i = at; i + n <= *argc; i++) argv[i] = argv[i + n];
    *argc -= n;
}

/* Every occurrence is removed: argp must not see any. */
bool take_flag(int *argc, char **argv, const char *name)
{
    bool found = false;
    for (int i = 1; i < *argc;) {
        if (strcmp(argv[i], "--") == 0) break;
        if (strcmp(argv[i], name) == 0) drop(argc, argv, i, 1), found = true;
        else i++;
    }
    return found;
}

/* As argp: "--name=value" and "--name value". A value that is missing is "". */
const char *take_first_value(int *argc, char **argv, const char *name)
{
    /* "--x" must not match "--xy": a whole word, or a whole word before "=". */
    const char *value;
    size_t length = strlen(name);
    for (int i = 1; i < *argc && strcmp(argv[i], "--") != 0; i++) {
        if (strncmp(argv[i], name, length) == 0 && argv[i][length] == '=') {
            value = argv[i] + length + 1;
            drop(argc, argv, i, 1);
            return value;
        }
        if (strcmp(argv[i], name) != 0) continue;
        value = i + 1 < *argc ? argv[i + 1] : "";
        drop(argc, argv, i, i + 1 < *argc ? 2 : 1);
        return value;
    }
    return NULL;
}

/* The last one counts. */
const char *take_value(int *argc, char **argv, const char *name)
{
    /* All are removed: argp must not see any of them. */
    const char *value = NULL, *next;
    while ((next = take_first_value(argc, argv, name)) != NULL) value = next;
    return value;
}

bool take_seconds(int *argc, char **argv, const char *name, double *seconds, struct err *e)
{
    const char *text = take_value(argc, argv, name);
    char *end;
    *seconds = 0;
    if (text == NULL) return true;
    *seconds = strtod(text, &end);
    if (end != text && *end == '\0' && isfinite(*seconds) && *seconds > 0) return true;
    return err_set(e, ERR_USAGE, "%s: '%.40s' is not a number of seconds above 0", name, text);
}

bool take_threads(int *argc, char **argv, int *threads, struct err *e)
{
    const char *text = take_value(argc, argv, "--threads");
    char *end;
    *threads = RUN_THREADS_AUTO;
    if (text == NULL || strcmp(text, "auto") == 0) return true;
    const long n = strtol(text, &end, 10);
    if (end == text || *end != '\0' || n < 1 || n > 1024)
        return err_set(e, ERR_USAGE,
                       "--threads: '%.40s' is neither 'auto' nor a number from 1 to 1024", text);
    *threads = (int)n;
    return true;
}

bool level_named(const char *option, const char *word, enum network_level *level, struct err *e)
{
    const char *name[LEVELS];
    struct text all = {0};
    for (int l = 0; l < LEVELS; l++) {
        name[l] = network_level_name((enum network_level)l);
        text_add(&all, "%s%s", l > 0 ? ", " : "; known: ", name[l]);
    }
    int found = 0;
    while (found < LEVELS && strcmp(word, name[found]) != 0) found++;
    if (found < LEVELS) *level = (enum network_level)found;
    else
        err_set(e, ERR_USAGE, "%sthere is no level '%.40s'%s", option, word,
                text_hint(word, name, LEVELS, all.s).s);
    text_free(&all);
    return found < LEVELS;
}
