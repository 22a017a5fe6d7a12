/* scenes.h - the measurements of accuracy, stability and omissions on the scenes that a report
 * shows them for. */
#ifndef APP_SCENES_H
#define APP_SCENES_H

#include "app/verb.h"
#include "store/store.h"

/* scenes_measure: the stability suite, and ladders, stability and savings of a serial chain, a
 * free-floating one, a humanoid tree, a four-bar and a stiff polymer, into `s`. What is stored
 * already is measured again only with c->force. Returns false as the verbs accuracy, stability and
 * explain --measure do. */
bool scenes_measure(const struct common *c, struct store *s, struct err *e);

#endif
