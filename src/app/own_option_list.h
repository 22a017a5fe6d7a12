/* own_option_list.h - the options that a single verb has: one line each, for its --help and for
 * misspelt ones.
 *
 * They are taken out of the arguments before the common ones are read (flag.h); a test holds this
 * list against the words that the verbs take. */
#ifndef APP_OWN_OPTION_LIST_H
#define APP_OWN_OPTION_LIST_H

/* X(verb, name, value, text): value NULL: the option takes none. */
#define OWN_OPTION_LIST(X)                                                                         \
    X("run", "shard", "K/N", "only the runs of shard K of N")                                      \
    X("run", "point", "ID", "only this run of the plan (mimdsim plan lists them)")                 \
    X("run", "limit", "SECONDS",                                                                   \
      "processor time that a run of your own program may take (default 600)")                      \
    X("run", "keep-all", NULL, "also compute what the scene does not need")                        \
    X("run", "campaign", "WAY", "mpi: the processes that mpirun started share the plan")           \
    X("run", "spread", "WAY",                                                                      \
      "mpi: the processes that mpirun started share the ranks of each run")                        \
    X("run", "backend", "WAY",                                                                     \
      "mpi: run for real, on the processes that mpirun started, instead of simulating")            \
    X("run", "samples", "N", "with --backend: undisturbed repetitions wanted (default 30)")        \
    X("calibrate", "quick", NULL, "fewer samples: under 30 s, else under 5 minutes")               \
    X("predict", "stages", NULL, "each stage on a line of its own")                                \
    X("record", "n", "N", "processes (default 2)")                                                 \
    X("record", "samples", "N", "repetitions (default 10)")                                        \
    X("record", "mpirun", "COMMAND", "the launcher with its options")                              \
    X("run", "threads", "N|auto", "host threads for each run (default auto)")                      \
    X("run", "uncertainty", "N",                                                                   \
      "draw the machine's uncertain parameters N times: bands and shares")                         \
    X("run", "bands-only", NULL, "with --uncertainty: without the shares of the variance")         \
    X("run", "columns", "NAME,...", "columns of the table, or all")                                \
    X("run", "csv", NULL, "print all columns with commas, for programs")                           \
    X("machines", "topology", NULL, "the networks: distances, bisection, costs; and pictures")     \
    X("plan", "shards", "N", "also the shard that each run belongs to")                            \
    X("plan", "format", "FORMAT", "lines (default) or json")                                       \
    X("paper", "paper-only", NULL, "without the five scenes of accuracy, stability and omissions") \
    X("claims", "explain", NULL, "what would have to change for the claims that fail to hold")     \
    X("claims", "what-if", NULL, "count runs on changed machines, too")                            \
    X("plot", "x", "KEY", "column or setting from left to right")                                  \
    X("plot", "y", "KEY", "column from bottom to top")                                             \
    X("plot", "z", "KEY", "of a heat map: the column that the colours show over --x and --y")      \
    X("plot", "by", "KEY,...", "columns that tell curves apart (default: as many as it takes)")    \
    X("plot", "where", "CONDITION",                                                                \
      "only rows with KEY=VALUE (or !=, <, <=, >, >=, ~); may be repeated")                        \
    X("plot", "kind", "KIND", "lines, bars or heat (default: as the columns are)")                 \
    X("plot", "log", "AXES",                                                                       \
      "logarithmic axes: x, y, xy or none (default: where the range asks for it)")                 \
    X("plot", "title", "TEXT", "of the figure")                                                    \
    X("plot", "as", "NAME", "name of the files (default: what is over what)")                      \
    X("plot", "columns", NULL, "list what --x, --y, --by and --where can name in this database")   \
    X("compare", "on", "SCENARIO", "what machines run to be compared (default speedup-t3e)")       \
    X("accuracy", "within", "ERROR", "recommend the cheapest way within this error, such as 2%")   \
    X("load", "traffic", "PATTERN,...", "what is sent where (default uniform)")                    \
    X("load", "routing", "NAME,...", "ways to choose routes (default: the machine's own)")         \
    X("load", "rates", "LOW:HIGH[:STEP]", "offered loads, or a list of them (default 0.05:1:0.05)")\
    X("load", "size", "SIZE", "payload of a message (default 64 B)")                               \
    X("load", "within", "PERCENT", "wanted half width of the mean's interval (default 2%)")        \
    X("load", "messages", "N", "most messages of a run (default 400000)")                          \
    X("load", "seed", "S", "of the random traffic (default 1)")                                    \
    X("load", "software", NULL, "message software limits the rate of messages, too")               \
    X("load", "no-saturation", NULL, "do not look for the load of saturation")                     \
    X("netcheck", "within", "PERCENT", "require every error to be within this, such as 2%")        \
    X("netcheck", "stated", NULL, "print the stated accuracies and run nothing")                   \
    X("timeline", "from", "TIME", "begin there, such as 1.2 ms")                                   \
    X("timeline", "to", "TIME", "end there")                                                       \
    X("timeline", "ranks", "A..B", "these ranks alone")                                            \
    X("explain", "measure", NULL, "also run with each omission undone, and tell what it saves")    \
    X("why", "brief", NULL, "the path and the contributions alone, from one run")                  \
    X("check", "again", "K",                                                                       \
      "of a database: make K of its runs (or all) again and compare every number")                 \
    X("check", "seed", "S", "which runs --again takes (default 1)")                                \
    X("lab", "variant", "STUDENT", "choose the numbers of the lesson by this name")                \
    X("lab", "grade", NULL, "one line for each of the folders, for teachers")                      \
    X("lab", "csv", NULL, "with grade: with commas, for spreadsheets")                             \
    X("lab", "mpi", NULL, "the program of the lesson is an MPI program")                           \
    X("scenarios", "keys", NULL, "all keys of scenarios, machine files and --set")                 \
    X("query", "upgrade", NULL, "make the database one of this version")                           \
    X("query", "schema", NULL, "print every table, view and column")

#endif
