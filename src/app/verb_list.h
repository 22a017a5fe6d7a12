/* verb_list.h - the verbs of the command line, one line each, in the order of `mimdsim --help`. A
 * new verb is a line here and a file cmd_WORD.c that defines it. Columns of X: function, word, one
 * line for --help. */
#ifndef APP_VERB_LIST_H
#define APP_VERB_LIST_H

#define VERB_LIST(X)                                                                               \
    X(cmd_run, "run", "run a scenario, store every run, print the table")                          \
    X(cmd_plan, "plan", "list the runs of a scenario, for engines that hand out work")             \
    X(cmd_merge, "merge", "join the databases of several hosts or shards")                         \
    X(cmd_mpirun, "mpirun", "run a program on virtual processors, as mpirun does")                 \
    X(cmd_calibrate, "calibrate", "measure this computer and write a machine file of it")          \
    X(cmd_predict, "predict", "compare measured runs with what a machine file predicts")           \
    X(cmd_record, "record", "measure an MPI program of its own on this computer")                  \
    X(cmd_paper, "paper", "reproduce the paper: runs, figures, claims, report")                    \
    X(cmd_claims, "claims", "judge the claims of the paper by a database")                         \
    X(cmd_plot, "plot", "draw a figure from a database")                                           \
    X(cmd_timeline, "timeline", "show when ranks compute, send and wait: picture, text or trace")  \
    X(cmd_compare, "compare", "compare machines, scenarios, runs or databases")                    \
    X(cmd_interference, "interference",                                                            \
      "measure how much longer jobs take beside each other")                                       \
    X(cmd_why, "why", "explain what limits a run, and what would help")                            \
    X(cmd_explain, "explain", "show what a scenario will run and cost")                            \
    X(cmd_check, "check", "validate files without running")                                        \
    X(cmd_machines, "machines", "list machines, show one with its sources, or compare two")        \
    X(cmd_scenarios, "scenarios", "list scenarios")                                                \
    X(cmd_keys, "keys", "list the settings with their units, ranges and defaults")                 \
    X(cmd_kernels, "kernels", "list built-in programs (programs lists all)")                       \
    X(cmd_programs, "programs", "list programs: built in, examples, your own")                     \
    X(cmd_new, "new", "write a parallel program to begin with, and its scenario")                  \
    X(cmd_lab, "lab", "learn: lessons to work through, with answers that are checked")             \
    X(cmd_verify, "verify", "compare every algorithm with reference vectors")                      \
    X(cmd_validate, "validate",                                                                    \
      "compare machines with published values, networks with references")                          \
    X(cmd_links, "links", "show the most heavily loaded links of a run")                           \
    X(cmd_load, "load", "measure latency and accepted load of networks against offered load")      \
    X(cmd_netcheck, "netcheck", "compare the network levels with reference results")               \
    X(cmd_accuracy, "accuracy",                                                                    \
      "measure error against run time: network, arithmetic, integration")                          \
    X(cmd_stability, "stability", "test every algorithm on stiff and extreme cases")               \
    X(cmd_report, "report", "report on a whole database: figures, Markdown and HTML")              \
    X(cmd_query, "query", "run SQL on a database")                                                 \
    X(cmd_cc, "cc", "compile C programs for virtual processors, as gcc does")                      \
    X(cmd_cxx, "c++", "compile C++ programs, as g++ does")                                         \
    X(cmd_f90, "f90", "compile Fortran programs, as gfortran does")

#endif
