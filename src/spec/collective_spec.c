/* collective_spec.c - see collective_spec.h. */
#include "spec/collective_spec.h"

#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "comm/collective_rules.h"

/* Those for which hardware has been built. Barriers have a setting of their own. */
static const enum collective_kind possible[] = {COLLECTIVE_BROADCAST, COLLECTIVE_REDUCE,
                                                COLLECTIVE_ALLREDUCE};
enum { POSSIBLE = sizeof possible / sizeof *possible, WORD = 32 };

/* One signal for all ranks, which is no collective: a bit behind those of the kinds. */
static const char eureka[] = "eureka";
static const unsigned eureka_bit = 1u << COLLECTIVE_KINDS;

/* Brackets as well: a YAML list is one text here. */
#define SEPARATORS "[], ;\t\n"

/* The kinds named in `text` as bits; false with the first word that names none in `word`. */
static bool read_kinds(const char *text, unsigned *kinds, char word[WORD])
{
    *kinds = 0;
    for (const char *s = text; *(s += strspn(s, SEPARATORS));) {
        const size_t length = strcspn(s, SEPARATORS);
        int k = 0;
        /* Longer words are cut, and then match nothing. */
        snprintf(word, WORD, "%.*s", (int)(length < WORD ? length : WORD - 1), s);
        while (k < POSSIBLE && strcmp(word, collective_name(possible[k])) != 0) k++;
        const bool signal = strcmp(word, eureka) == 0;
        if (k == POSSIBLE && !signal) return false;
        *kinds |= signal ? eureka_bit : 1u << possible[k];
        s += length;
    }
    return true;
}

/* Nothing at all is valid, too: a network without. Names are those of collectives (collectives.h).
 */
bool collective_kinds_valid(const char *text, char *why, int size)
{
    unsigned kinds;
    char word[WORD];
    const char *name[POSSIBLE + 1] = {eureka};
    if (read_kinds(text, &kinds, word)) return true;
    for (int i = 0; i < POSSIBLE; i++) name[1 + i] = collective_name(possible[i]);
    /* The nearest of those that there are, as for every misspelt name. */
    const char *near = text_nearest(word, name, POSSIBLE + 1);
    /* The one that is looked for most often under this key has another. */
    if (strcmp(word, "barrier") == 0)
        snprintf(why, (size_t)size,
                 "barriers are not listed here; expected 'software.barrier.kind: hardware'");
    else
        snprintf(why, (size_t)size, "'%s' is no collective of networks; expected %s%s%s", word,
                 near ? "'" : "", near ? near : "some of broadcast, reduce, allreduce, eureka",
                 near ? "'" : "");
    return false;
}

/* Settings in words and bits as programs ask for them. Operations of the file are cumulative, as
 * those of comm_type.h: a network that adds floating-point numbers also adds whole ones. */
struct comm_hardware collective_hardware(const struct machine_spec *m)
{
    static const enum comm_operation operations[] = {[OPERATIONS_LOGICAL] = COMM_LOGICAL,
                                                     [OPERATIONS_INTEGER] = COMM_INTEGER,
                                                     [OPERATIONS_REAL] = COMM_REAL};
    const struct network_collective_spec *c = &m->network.collective;
    struct comm_hardware h = {.operations = operations[c->operations],
                              .largest = c->largest > 0 ? c->largest : INT64_MAX};
    char word[WORD];
    /* Checked when the file was read: nothing can be wrong here. */
    read_kinds(c->kinds, &h.kinds, word);
    h.eureka = (h.kinds & eureka_bit) != 0;
    h.kinds &= ~eureka_bit;
    if (m->software.barrier == BARRIER_HARDWARE) h.kinds |= 1u << COLLECTIVE_BARRIER;
    return h;
}

/* The key by which a machine says whether its network does `kind`. */
static const char *key_of(enum collective_kind kind)
{
    return kind == COLLECTIVE_BARRIER ? "software.barrier.kind" : "network.collective.kinds";
}

/* The first reason of several: kind, size, operation. */
void collective_refusal(const struct machine_spec *m, const struct collective_shape *s, char *why,
                        int size)
{
    /* All that is asked here is in the machine's file: each reason names its key. */
    const struct comm_hardware h = collective_hardware(m);
    const char *kind = collective_name(s->kind);
    const int64_t bytes = s->count * s->element;
    if (!(h.kinds >> s->kind & 1))
        snprintf(why, (size_t)size, "the network of %s has no hardware for %s (%s)", m->name, kind,
                 key_of(s->kind));
    else if (bytes > h.largest)
        snprintf(why, (size_t)size,
                 "the network of %s takes vectors of at most %lld B (network.collective.largest), "
                 "this one has %lld B",
                 m->name, (long long)h.largest, (long long)bytes);
    else
        snprintf(why, (size_t)size,
                 "the network of %s cannot do this operation (network.collective.operations)",
                 m->name);
}

/* Rules are texts that were checked as such; whether the machine has what they name is known only
 * when all of its file has been read. */
bool collective_rules_fit(const struct machine_spec *m, char *why, int size)
{
    struct collective_rule rule[COLLECTIVE_MAX_RULES];
    int n;
    /* Barriers are among them where the machine has one of its own. */
    const unsigned kinds = collective_hardware(m).kinds;
    if (!collective_rules_parse(m->software.collectives, rule, &n, why, size)) return false;
    /* The first rule that does not fit is told; there is one text for all. */
    for (int i = 0; i < n; i++) {
        const struct collective_rule *r = &rule[i];
        if (!collective_by_network(r->algorithm) || kinds >> r->kind & 1) continue;
        const char *kind = collective_name(r->kind);
        snprintf(why, (size_t)size,
                 "software.collectives says '%s %s', but the network of %s has no hardware for %s "
                 "(%s)",
                 kind, r->algorithm->name, m->name, kind, key_of(r->kind));
        return false;
    }
    return true;
}

/* Whether `name` is what some collective by the network is called. */
static bool names_network(const char *name)
{
    for (int i = 0; i < COLLECTIVE_KINDS; i++) {
        const struct collective_algorithm *a =
            collective_algorithm_find((enum collective_kind)i, name);
        if (a != NULL && collective_by_network(a)) return true;
    }
    return false;
}

/* A name goes before the rules. What a rule is for is not looked at: one thread is always right. */
bool collective_meets(const struct run_spec *r)
{
    const char *name = r->kernel.algorithm;
    struct collective_rule rule[COLLECTIVE_MAX_RULES];
    char why[160];
    int n;
    bool meets = false;
    if (!kernel_spec_has(&r->kernel, PROGRAM_COLLECTIVE)) return false;
    if (r->machine.network.collective.kinds[0] == '\0') return false;
    /* An algorithm by name is taken whatever the machine's rules say. */
    if (*name && strcmp(name, "auto") != 0) return names_network(name);
    if (!collective_rules_parse(r->machine.software.collectives, rule, &n, why, sizeof why))
        return false;
    for (int i = 0; i < n; i++) meets = meets || collective_by_network(rule[i].algorithm);
    return meets;
}
