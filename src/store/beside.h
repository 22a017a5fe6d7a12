/* beside.h - files that are written beside their place, never through a link, and what a crash left of them. */
#ifndef STORE_BESIDE_H
#define STORE_BESIDE_H

/* beside_open: make a new file PATH.new-XXXXXX.part in the folder of `path`, open it for writing and lock it (flock).
 *
 *   *name  its path, for the caller to free; NULL on failure
 *
 * The name is drawn anew until none has it (mkostemp), so nothing that lies there, a link least of all, is ever opened.
 * Its mode is what the umask leaves of 0666. Returns the descriptor, or -1 with errno. */
int beside_open(const char *path, char **name);

/* beside_clean: remove the files that beside_open made for `path` in processes that have ended since. Those that a
 * living process writes are locked and stay, as do links and files of other users. */
void beside_clean(const char *path);

#endif
