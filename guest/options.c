/* options.c - getopt, getopt_long: the C library's keep their place in variables of the process;
 * these are the rank's.
 *
 * As POSIX and the GNU manual (25.2) say: arguments that are no options are moved behind those that
 * are, unless the first character of `options` is '+', or POSIXLY_CORRECT is set; '-' hands them
 * over as option 1. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guest.h"

char *optarg WEAK;
int optind WEAK = 1;
int opterr WEAK = 1;
int optopt WEAK = '?';

static char *next;      /* within a word of short options */
static int first, last; /* words passed over: first .. last - 1 */

struct request {
    int n;
    char **word;
    const char *options;
    const struct option *longs;
    int *which;
    int only;   /* getopt_long_only: one dash does, too */
    int silent; /* options begin with a colon */
};

static void complain(const struct request *r, const char *text, const char *name)
{
    if (opterr && !r->silent) fprintf(stderr, "%s: %s -- '%s'\n", r->word[0], text, name);
}

/* The words passed over change places with the options behind them: first .. last - 1 with last ..
 * optind - 1. */
static void exchange(char **word)
{
    for (; last < optind; last++, first++) {
        char *option = word[last];
        memmove(&word[first + 1], &word[first], (size_t)(last - first) * sizeof *word);
        word[first] = option;
    }
}

static int is_option(const struct request *r, int i)
{
    return r->word[i][0] == '-' && r->word[i][1] != '\0';
}

/* An argument of the option: the rest of its word, or the next word. */
static int take_argument(const struct request *r, char *rest, const char *name, int option)
{
    optarg = rest;
    if (rest) return option;
    if (optind < r->n) {
        optarg = r->word[optind++];
        return option;
    }
    complain(r, "option requires an argument", name);
    optopt = option;
    return r->silent ? ':' : '?';
}

/* The long option that `name` (n characters) means: exactly, or as the only one that begins so;
 * NULL: none. */
static const struct option *find_long(const struct request *r, const char *name, size_t n,
                                      int *several)
{
    const struct option *found = NULL;
    *several = 0;
    for (const struct option *o = r->longs; o && o->name; o++) {
        if (strncmp(o->name, name, n) != 0) continue;
        if (strlen(o->name) == n) {
            *several = 0;
            return o;
        }
        if (found &&
            (found->has_arg != o->has_arg || found->flag != o->flag || found->val != o->val))
            *several = 1;
        found = found ? found : o;
    }
    return found;
}

static int take_long(const struct request *r, char *name)
{
    const size_t n = strcspn(name, "=");
    int several;
    const struct option *o = find_long(r, name, n, &several);
    char *value = name[n] ? name + n + 1 : NULL;
    next = NULL;
    optind++;
    optopt = 0;
    if (!o || several) {
        complain(r, several ? "option is ambiguous" : "unrecognized option", name);
        return '?';
    }
    optopt = o->val;
    if (r->which) *r->which = (int)(o - r->longs);
    optarg = value;
    if (value && o->has_arg == no_argument) {
        complain(r, "option doesn't allow an argument", o->name);
        return '?';
    }
    const int result = o->flag ? 0 : o->val;
    if (!value && o->has_arg == required_argument) {
        int got = take_argument(r, NULL, o->name, result);
        if (got != result) {
            optopt = o->val;
            return got;
        }
    }
    if (o->flag) *o->flag = o->val;
    return result;
}

static int take_short(const struct request *r)
{
    const char option = *next++, name[2] = {option, '\0'};
    const char *known = option == ':' || option == ';' ? NULL : strchr(r->options, option);
    char *rest = *next ? next : NULL;
    if (!rest) optind++;
    if (!known) {
        complain(r, "invalid option", name);
        optopt = option;
        if (!rest) next = NULL;
        return '?';
    }
    if (known[1] != ':') {
        if (!rest) next = NULL;
        return option;
    }
    next = NULL;
    if (rest) optind++;
    if (known[2] != ':') return take_argument(r, rest, name, option);
    optarg = rest; /* an argument that may be missing stands in the same word */
    return option;
}

static int get(struct request r)
{
    const int in_order = *r.options == '-',
              stop = *r.options == '+' || (!in_order && getenv("POSIXLY_CORRECT"));
    optarg = NULL;
    if (*r.options == '-' || *r.options == '+') r.options++;
    r.silent = *r.options == ':';
    if (optind == 0)
        optind = 1, next = NULL, first = last = 1; /* a program asks for a new start so */
    if (first == 0 || last > optind || first > optind) first = last = optind;
    if (next && *next) return take_short(&r);

    /* At the beginning of a word. Those that are no options are remembered as passed over. */
    if (!stop && !in_order) {
        if (first != last && last != optind) exchange(r.word);
        else if (last != optind) first = optind;
        while (optind < r.n && !is_option(&r, optind)) optind++;
        last = optind;
    }
    if (optind < r.n && strcmp(r.word[optind], "--") == 0) {
        optind++;
        if (first != last && last != optind) exchange(r.word);
        else if (first == last) first = optind;
        last = optind = r.n;
    }
    if (optind >= r.n) {
        if (first != last) optind = first;
        return -1;
    }
    if (!is_option(&r, optind)) {
        if (stop) return -1;
        optarg = r.word[optind++];
        return 1;
    }
    char *word = r.word[optind];
    if (r.longs && word[1] == '-') return take_long(&r, word + 2);
    int several;
    if (r.longs && r.only && (word[2] || !strchr(r.options, word[1])) &&
        find_long(&r, word + 1, strcspn(word + 1, "="), &several))
        return take_long(&r, word + 1);
    next = word + 1;
    return take_short(&r);
}

WEAK int getopt(int n, char *const *word, const char *options)
{
    return get((struct request){.n = n, .word = (char **)(uintptr_t)word, .options = options});
}

WEAK int getopt_long(int n, char *const *word, const char *options, const struct option *longs,
                     int *which)
{
    return get((struct request){.n = n,
                                .word = (char **)(uintptr_t)word,
                                .options = options,
                                .longs = longs,
                                .which = which});
}

WEAK int getopt_long_only(int n, char *const *word, const char *options, const struct option *longs,
                          int *which)
{
    return get((struct request){.n = n,
                                .word = (char **)(uintptr_t)word,
                                .options = options,
                                .longs = longs,
                                .which = which,
                                .only = 1});
}
