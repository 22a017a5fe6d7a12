/* collective_rules.c - rules for the choice of algorithms, read from text (collective_rules.h).
 *
 *     rules = rule; rule; ..      rule = COLLECTIVE ALGORITHM [from SIZE] [on N [ranks]]
 *     allreduce ring from 64 KiB on 8 ranks; broadcast binomial
 *
 * The same text stands in machine files, on the command line and in the store. Of all rules that
 * match the last one counts, so that general rules come first. */
#include "comm/collective_rules.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "base/units.h"

/* Longer words are cut, and then match nothing. */
enum { WORD = 48, MAX_ALGORITHMS = 64 };

/* Always false: a refusal is one statement. The attribute lets the compiler check the format. */
static bool refuse(char *why, int size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool refuse(char *why, int size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(why, (size_t)size, format, args);
    va_end(args);
    return false;
}

/* For messages: what would have been right. */
void collective_algorithm_names(enum collective_kind kind, char *buffer, int size)
{
    int n, at = 0;
    const struct collective_algorithm *row = collective_algorithms(kind, &n);
    for (int i = 0; i < n && at < size; i++)
        at += snprintf(buffer + at, (size_t)(size - at), "%s%s", i > 0 ? ", " : "", row[i].name);
}

/* The nearest name, if one is near; else two examples. */
static bool no_collective(const char *word, char *why, int size)
{
    const char *name[COLLECTIVE_KINDS];
    for (int k = 0; k < COLLECTIVE_KINDS; k++) name[k] = collective_name((enum collective_kind)k);
    const char *near = text_nearest(word, name, COLLECTIVE_KINDS);
    return refuse(why, size, "no collective is called '%s'; expected %s%s%s", word,
                  near ? "'" : "broadcast, allreduce ...", near ? near : "", near ? "'" : "");
}

/* The word at *s, which moves behind it and the blanks that follow. */
static void take_word(const char **s, char word[WORD])
{
    int n = 0;
    for (; **s && !isspace((unsigned char)**s); (*s)++)
        if (n < WORD - 1) word[n++] = **s;
    word[n] = '\0';
    while (isspace((unsigned char)**s)) (*s)++;
}

/* "2 KiB" up to "on", another "from" or the end: a size may be two words. They are put together
 * with one blank and read as every other quantity (base/units.h). */
static bool take_size(const char **s, int64_t *bytes, char *why, int size)
{
    char quantity[WORD] = "", word[WORD];
    double value;
    for (const char *next = *s; *next;) {
        take_word(&next, word);
        /* These begin the next condition, which stays in the text. */
        if (strcmp(word, "on") == 0 || strcmp(word, "from") == 0) break;
        /* One word more of the size, if there is room for it and a blank. */
        size_t used = strlen(quantity), more = strlen(word);
        if (used + more + 2 > sizeof quantity)
            return refuse(why, size, "'from %s ...' is no size", quantity);
        if (used > 0) quantity[used++] = ' ';
        memcpy(quantity + used, word, more + 1);
        *s = next;
    }
    if (!units_parse(quantity, UNIT_BYTES, &value, why, size)) return false;
    if (value < 0 || value > 1e15) return refuse(why, size, "'from %s' is no size", quantity);
    *bytes = (int64_t)value;
    return true;
}

/* "ranks" behind the number is optional. */
static bool take_ranks(const char **s, int *ranks, char *why, int size)
{
    char word[WORD];
    char *end;
    take_word(s, word);
    long value = strtol(word, &end, 10);
    if (end == word || *end || value < 0 || value > 1 << 30)
        return refuse(why, size, "'on %s': expected a number of ranks such as 'on 8 ranks'", word);
    *ranks = (int)value;
    const char *next = *s;
    take_word(&next, word);
    if (strcmp(word, "ranks") == 0) *s = next;
    return true;
}

/* "COLLECTIVE ALGORITHM [from SIZE] [on N [ranks]]". The algorithm is looked up in the table of its
 * collective: "ring" exists for several. */
static bool take_rule(const char *s, struct collective_rule *rule, char *why, int size)
{
    char word[WORD], names[240];
    *rule = (struct collective_rule){.from_bytes = 0};
    take_word(&s, word);
    rule->kind = collective_find(word);
    if (rule->kind == COLLECTIVE_KINDS) return no_collective(word, why, size);
    take_word(&s, word);
    rule->algorithm = collective_algorithm_find(rule->kind, word);
    if (!rule->algorithm) {
        collective_algorithm_names(rule->kind, names, (int)sizeof names);
        return refuse(why, size, "%s has no algorithm '%s'; expected one of %s",
                      collective_name(rule->kind), word, names);
    }
    /* Conditions in any order; the same twice: the later one holds. */
    while (*s) {
        take_word(&s, word);
        /* Each condition is a word and what belongs to it. */
        bool from = strcmp(word, "from") == 0, on = strcmp(word, "on") == 0;
        if (from && !take_size(&s, &rule->from_bytes, why, size)) return false;
        if (on && !take_ranks(&s, &rule->from_ranks, why, size)) return false;
        if (!from && !on)
            return refuse(why, size,
                          "'%s': expected 'from SIZE' or 'on N ranks' after the algorithm", word);
    }
    return true;
}

bool collective_rules_parse(const char *text, struct collective_rule *rule, int *n, char *why,
                            int size)
{
    char part[256];
    *n = 0;
    for (const char *s = text; *s;) {
        /* Brackets, commas and line ends as well: a YAML list of rules is one text here. */
        s += strspn(s, "[]; ,\t\n");
        size_t length = strcspn(s, ";,]");
        /* Two separators in a row hold no rule between them. */
        if (length == 0) continue;
        if (length >= sizeof part)
            return refuse(why, size, "a rule of %zu characters is too long", length);
        if (*n == COLLECTIVE_MAX_RULES)
            return refuse(why, size, "more than %d rules", COLLECTIVE_MAX_RULES);
        memcpy(part, s, length);
        part[length] = '\0';
        struct collective_rule one;
        if (!take_rule(part, &one, why, size)) return false;
        if (rule) rule[*n] = one;
        (*n)++;
        /* The next rule begins behind this one and its separators. */
        s += length;
    }
    return true;
}

/* For settings: checked where they are read, parsed again where they are used. */
bool collective_rules_valid(const char *text, char *why, int size)
{
    int n;
    return collective_rules_parse(text, NULL, &n, why, size);
}

/* Which collective it will be is not known here: any name of any table will do. */
bool collective_choice_valid(const char *text, char *why, int size)
{
    const char *name[MAX_ALGORITHMS] = {"auto"};
    int n = 1;
    if (strcmp(text, "auto") == 0) return true;
    for (int k = 0; k < COLLECTIVE_KINDS; k++) {
        int nrow;
        const struct collective_algorithm *row =
            collective_algorithms((enum collective_kind)k, &nrow);
        for (int i = 0; i < nrow && n < MAX_ALGORITHMS; i++) name[n++] = row[i].name;
    }
    for (int i = 0; i < n; i++)
        if (strcmp(text, name[i]) == 0) return true;
    const char *near = text_nearest(text, name, n);
    return refuse(why, size, "no collective has such an algorithm; expected 'auto' or a name%s%s%s",
                  near ? " such as '" : "", near ? near : " (docs/collectives.md)",
                  near ? "'" : "");
}
