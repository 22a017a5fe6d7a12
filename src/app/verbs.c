/* verbs.c - the table of verbs. */
#include "app/verb.h"

const struct verb verb_list[] = {
    {"run", "run a scenario, store every run, print the table", cmd_run},
    {"paper", "reproduce the paper: runs, figures, claims, report", cmd_paper},
    {"claims", "judge the claims of the paper by a database", cmd_claims},
    {"plot", "draw a figure from a database", cmd_plot},
    {"timeline", "show when ranks compute, send and wait: picture, text or trace", cmd_timeline},
    {"explain", "show what a scenario will run and cost", cmd_explain},
    {"check", "validate files without running", cmd_check},
    {"machines", "list machines, show one with its sources, or compare two", cmd_machines},
    {"scenarios", "list scenarios", cmd_scenarios},
    {"kernels", "list kernels", cmd_kernels},
    {"verify", "compare every algorithm with reference vectors", cmd_verify},
    {"validate", "compare machines with published values, networks with references", cmd_validate},
    {"links", "show the most heavily loaded links of a run", cmd_links},
    {"netcheck", "compare the network levels with reference results", cmd_netcheck},
    {"accuracy", "measure error against run time: network, arithmetic, integration", cmd_accuracy},
    {"stability", "test every algorithm on stiff and extreme cases", cmd_stability},
    {"report", "report on a whole database: figures, Markdown and HTML", cmd_report},
    {"query", "run SQL on a database", cmd_query},
    {0},
};
