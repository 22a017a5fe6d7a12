/* verbs.c - the table of verbs, from their list. A verb is a line in verb.h and a file of its
 * own. */
#include "app/verb.h"

const struct verb verb_list[] = {
#define X(function, word, title) {word, title, function},
    VERB_LIST(X)
#undef X
    {0},
};
