/* planar_scene.h - what the files of the serial planar dynamics share: bodies in motion, and the
 * scene they are in. */
#ifndef DYNAMICS_PLANAR_SCENE_H
#define DYNAMICS_PLANAR_SCENE_H

#include "base/work.h"
#include "dynamics/planar_body.h"

/* A body in motion. Symmetric matrices: [about the normal; x; y] as aa, ax, ay, xx, xy, yy. */
struct moving {
    struct body_pose pose;
    real w; /* rate about the normal */
    real bias[SPACE];
    real a[SPACE];   /* acceleration */
    real f[SPACE];   /* force on the body by its parent; while articulating: bias force */
    real inertia[6]; /* articulated */
    real per, rest;  /* 1 / inertia along the joint; what is left of the joint force there */
};

struct scene {
    const struct model *model;
    const struct state *state;
    const struct body *body;
    struct moving *moving;
    real base[SPACE];
    const real *load; /* (nbody x 3) forces of loops on the bodies; NULL: none */
    bool terms;       /* with velocity terms, wrenches and the base's acceleration */
};

/* planar_scene_take: everything of one call, in `scratch`. planar_start: body i placed and set in
 * motion, parents first. */
struct scene planar_scene_take(const struct model *m, const struct state *s, struct arena *scratch);
void planar_start(const struct scene *x, int i, struct work *w);

/* planar_joint_motion: h (3): the joint's velocity (or acceleration) from its rates: about the
 * normal and along x, y. Signs cost nothing. */
void planar_joint_motion(const struct body *b, const double *u, real *h);

/* planar_open_forward: accelerations ud (nu) of the scene cut open for joint forces tau (nu), with
 * x's loads and terms; the bodies have been placed. False: nothing resists along some joint. */
bool planar_open_forward(const struct scene *x, const double *tau, double *ud, struct work *w);

#endif
