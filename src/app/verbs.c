/* verbs.c - the table of verbs, from their list. */
#include "app/verb.h"

const struct verb verb_list[] = {
#define X(function, word, title) {word, title, function},
    VERB_LIST(X)
#undef X
    {0},
};
