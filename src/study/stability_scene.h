/* stability_scene.h - the scenes of the suite, and what its parts share; private to
 * stability*.c. */
#ifndef STUDY_STABILITY_SCENE_H
#define STUDY_STABILITY_SCENE_H

#include "model/model.h"
#include "study/stability.h"

/* How the masses of a chain are spread. */
enum spread {
    SPREAD_EVEN,
    SPREAD_HEAVY_TIP,
    SPREAD_LIGHT_TIP,
    SPREAD_LIGHT_BASE,
    SPREAD_UP,
    SPREAD_DOWN,
    SPREAD_RANDOM,
    SPREAD_ALTERNATING
};

struct stability_scene {
    const char *name;
    struct model_spec spec;
    enum spread spread;
    double ratio;   /* largest over smallest mass */
    double point;   /* factor of all inertias about centres of mass; 0: 1 */
    double nudge;   /* added to every coordinate, alternating sign */
    bool weightless, at_rest;
    bool complete;  /* spec says everything: nothing is to be filled in */
    bool moves;     /* stiff: steppers are tried on it too */
};

/* scene_list: the suite, (*n) scenes. */
const struct stability_scene *scene_list(int *n);

/* scene_build: model and state; false with *e set. */
bool scene_build(const struct stability_scene *c, struct arena *a, struct model **m,
                 struct state **s, struct err *e);

/* row_add: a failed row without numbers. The pointer holds until the next is added. */
struct stability_row *row_add(struct stability_report *r, const char *subject,
                              const char *algorithm, const char *precision);

/* row_grade: error and status; limits of `single` precision or of double. */
void row_grade(struct stability_row *row, double error, bool single);

/* stability_accelerations: rows of every forward algorithm; `causes`: rows that are not ok are run
 * again in quad precision, up to 1,100 bodies, and say what is wrong with them. stability_motion:
 * rows of the steppers on a stiff scene; stability_energy: of two steppers on any other, its motors
 * off, for as long as its fastest joint needs to turn by a third of a radian. */
void stability_accelerations(struct stability_report *r, const char *subject, const struct model *m,
                             const struct state *s, bool causes, struct arena *scratch);
void stability_motion(struct stability_report *r, const char *subject, const struct model *m,
                      const struct state *s, bool damped, struct arena *scratch);
void stability_energy(struct stability_report *r, const char *subject, const struct model *m,
                      const struct state *s, struct arena *scratch);

#endif
