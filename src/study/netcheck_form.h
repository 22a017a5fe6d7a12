/* netcheck_form.h - the forms of reference cases: which keys each has, which are needed, which are
 * compared.
 *
 *   form         told by              asks for
 *   step         distance             every node sends one message by `pattern`: makespan,
 * arrivals; or a band list         trace {src, ...}     messages with dependencies: makespan,
 * arrivals hand         messages [{...}]     a few messages: arrivals by hand and by the reference
 *   load         points [{...}]       mean latency under a random load
 *   saturation   saturation_low       the load at which the latency is three times that of the
 * empty network
 *
 * A step, a list and a hand case without any answer are played; the cases of a file all have
 * answers or none. Every key is looked at: one that is needed and not there, and one that is almost
 * one that is not there, are errors; one that nothing is compared with is noted. */
#ifndef STUDY_NETCHECK_FORM_H
#define STUDY_NETCHECK_FORM_H

#include "io/document.h"
#include "study/netcheck.h"

/* Which keys the first case of a form has, by their numbers in its table. */
struct netcheck_alike {
    const void *table;
    unsigned has;
};

/* What is needed to read a file. */
struct netcheck_reader {
    struct netcheck *n;
    const char *path, *filter;
    struct arena *rows;  /* keeps the rows, and what their answers hold */
    struct arena *arena; /* scratch, released after each case */
    struct err *e;
    int capacity;
    int ncase;     /* read before */
    bool referred; /* they have answers */
    struct netcheck_alike alike[8];
};

/* netcheck_is_series: whether a case of a load gives its network by parameters, names the rule, and
 * is played by that rule (netcheck_series.c). */
bool netcheck_is_series(const struct node *c);

/* netcheck_form_of: the form of case c and whether it has reference answers; its keys looked at.
 * Returns false with ERR_DATA: no known form (which are known), a key missing or misspelt. */
bool netcheck_form_of(struct netcheck_reader *r, const struct node *c, enum netcheck_form *form,
                      bool *referred);

/* netcheck_keys_complete: whether a case with answers says all of its conditions and answers; asked
 * once its values are known to make sense, so that the worse mistake is told. Returns false with
 * ERR_DATA. */
bool netcheck_keys_complete(struct netcheck_reader *r, const struct node *c,
                            enum netcheck_form form, bool referred);

/* netcheck_keys_of_point, netcheck_keys_of_trace, netcheck_keys_of_message: the same for what
 * stands inside a case of a load, of a list (referred: it has answers), and for one message of a
 * hand case. */
bool netcheck_keys_of_point(struct netcheck_reader *r, const struct node *point);
bool netcheck_keys_of_trace(struct netcheck_reader *r, const struct node *trace, bool referred);
bool netcheck_keys_of_message(struct netcheck_reader *r, const struct node *message, bool referred);

/* netcheck_integer: the integer `key` of c in lo .. hi into *i; `otherwise` where it is missing or
 * null. Returns false with ERR_DATA. */
bool netcheck_integer(struct netcheck_reader *r, const struct node *c, const char *key, int lo,
                      int hi, int otherwise, int *i);

/* netcheck_truth: whether `key` of c is true; missing: false. Returns false with ERR_DATA when it
 * is neither. */
bool netcheck_truth(struct netcheck_reader *r, const struct node *c, const char *key, bool *truth);

/* netcheck_word: the text `key` of c into *word. Returns false with ERR_DATA when it is no text. */
bool netcheck_word(struct netcheck_reader *r, const struct node *c, const char *key,
                   const char **word);

#endif
