/* backend.h - `mimdsim run --backend mpi`: the runs of a scenario on this computer, for real. */
#ifndef APP_BACKEND_H
#define APP_BACKEND_H

/* backend_run: the whole of `mimdsim run` when --backend `backend` was given, which has been taken
 * out of the arguments; returns the exit status of this process. */
int backend_run(int argc, char **argv, const char *backend);

#endif
