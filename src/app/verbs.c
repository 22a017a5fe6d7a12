/* verbs.c - the table of verbs. */
#include "app/verb.h"

const struct verb verb_list[] = {
    {"run", "run a scenario, store every run, print the table", cmd_run},
    {"paper", "reproduce the paper: runs, figures, claims, report", cmd_paper},
    {"claims", "judge the claims of the paper by a database", cmd_claims},
    {"plot", "draw a figure from a database", cmd_plot},
    {"timeline", "who computes, sends and waits when, as picture, text or trace", cmd_timeline},
    {"explain", "what a scenario will run, what it will cost", cmd_explain},
    {"check", "validate files without running", cmd_check},
    {"machines", "list machines; show one with its sources; compare two", cmd_machines},
    {"scenarios", "list scenarios", cmd_scenarios},
    {"kernels", "list kernels", cmd_kernels},
    {"verify", "hold every algorithm against reference vectors", cmd_verify},
    {"validate", "machines beside published figures, networks beside references", cmd_validate},
    {"links", "the most loaded links of a run", cmd_links},
    {"netcheck", "hold the network levels against reference answers", cmd_netcheck},
    {"accuracy", "error against run time: network, arithmetic, integration", cmd_accuracy},
    {"stability", "stiff and extreme cases against every algorithm", cmd_stability},
    {"report", "all that a database holds, as figures, Markdown and HTML", cmd_report},
    {"query", "run SQL on a database", cmd_query},
    {0},
};
