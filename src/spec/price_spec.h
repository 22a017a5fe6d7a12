/* price_spec.h - what a network costs, by router, port and metre of cable. */
#ifndef SPEC_PRICE_SPEC_H
#define SPEC_PRICE_SPEC_H

/* What a network costs, for comparisons of networks; no part of what a run is. Prices in any one
 * currency. */
struct price_spec {
    double router, port, cable, metre; /* each; a cable of any length, and a metre of it */
    double router_power, port_power;   /* [W] each */
    int rack_routers;                  /* routers in a rack, 0: no floor plan */
    double rack_pitch;                 /* from rack to rack [m] */
};

#endif
