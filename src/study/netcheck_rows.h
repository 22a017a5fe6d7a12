/* netcheck_rows.h - what the readers of all forms of reference case share; private to
 * netcheck*.c. */
#ifndef STUDY_NETCHECK_ROWS_H
#define STUDY_NETCHECK_ROWS_H

#include "study/netcheck_ask.h"
#include "study/netcheck_form.h"

/* What is said of a case's network. */
struct netcheck_setting {
    const char *topology;
    int channels, buffer, tie, packet_flits; /* channels 0: as many as the routes need */
};

/* netcheck_begin: a new row for case c, and the question that fills it. */
struct netcheck_question netcheck_begin(struct netcheck_reader *r, const struct node *c,
                                        enum netcheck_form form);

/* netcheck_wanted: whether the row, whose name is set, passes the filter; else it is taken back. */
bool netcheck_wanted(const struct netcheck_reader *r, const struct netcheck_question *k);

/* netcheck_setting_read: the setting of case c. Returns false with ERR_DATA. */
bool netcheck_setting_read(struct netcheck_reader *r, const struct node *c,
                           struct netcheck_setting *s);

/* netcheck_network: k's machine and topology. False with an error in r->e, or with none where the
 * network is not one of ours and the row says so: netcheck_told tells which. */
bool netcheck_network(struct netcheck_reader *r, const struct node *c,
                      const struct netcheck_setting *s, struct netcheck_question *k);
bool netcheck_told(const struct netcheck_reader *r);

/* netcheck_head_cycles: cycles that a head takes over a router of case c; 0 with ERR_DATA. */
int netcheck_head_cycles(struct netcheck_reader *r, const struct node *c);

/* netcheck_flaw: note that the reference says `found` of `what` where the case makes it `expected`;
 * the first one counts. netcheck_flaw_of_key: the same for the number `key` of c, if it is
 * there. */
void netcheck_flaw(struct netcheck_row *row, const char *what, double found, double expected);
void netcheck_flaw_of_key(struct netcheck_row *row, const struct node *c, const char *key,
                          double expected);

/* netcheck_given: the number `key` of c; NULL when it is missing or null, and with a flaw when it
 * is none. */
const struct node *netcheck_given(struct netcheck_row *row, const struct node *c, const char *key);

/* netcheck_check_arrivals: k's reference arrivals against its makespan and against an empty
 * network, in which no message is slower. */
void netcheck_check_arrivals(struct netcheck_question *k, double makespan);

/* The rows of one case of each form. Return false with ERR_DATA. */
bool netcheck_step_rows(struct netcheck_reader *r, const struct node *c, bool referred);
bool netcheck_list_rows(struct netcheck_reader *r, const struct node *c, bool referred);
bool netcheck_hand_rows(struct netcheck_reader *r, const struct node *c, bool referred);
bool netcheck_load_rows(struct netcheck_reader *r, const struct node *c);
bool netcheck_series_rows(struct netcheck_reader *r, const struct node *c);
bool netcheck_saturation_rows(struct netcheck_reader *r, const struct node *c);

#endif
