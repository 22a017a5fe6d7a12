/* network_file.h - the networks of machine files and scenarios, built without running anything:
 * what a file alone cannot tell, such as a failed link that no network of this size has. */
#ifndef STUDY_NETWORK_FILE_H
#define STUDY_NETWORK_FILE_H

#include <stdbool.h>

#include "base/err.h"
#include "plan/plan.h"

/* network_file_check: build the network of a machine file, or that of every run of a scenario, that
 * plan_check_file takes; nothing is done for other files.
 *
 *   Returns false as topology_create, with the file and, of a machine, the line of the setting. */
bool network_file_check(const char *path, const struct plan_options *o, struct err *e);

#endif
