/* program_file.h - people's own programs in scenarios: which files, what they declare, and their
 * parameters as settings.
 *
 * Programs are compiled and loaded above this room, by plan_options.program. A scenario names its
 * programs before any of its other keys is read, since what they declare are keys, too: `n: 100` is
 * `program.n: 100` where a program declares n. Whoever writes a scenario may name any file, so only
 * those in the scenario's folder are taken unless plan_options.allow_programs says otherwise; what
 * the command line names is the user's own wish. */
#ifndef PLAN_PROGRAM_FILE_H
#define PLAN_PROGRAM_FILE_H

#include "plan/scenario_file.h"

/* program_file_is: whether `name`, an argument of the command line, is a program and no scenario:
 * by its ending, or as an ELF file. */
bool program_file_is(const char *name);

/* program_file_scenario: the scenario that program `name` makes by itself: on machine t3e-300, with
 * 1 to 16 ranks. NULL with ERR_DATA. */
struct node *program_file_scenario(const char *name, struct arena *a, struct err *e);

/* program_file_entitle: name and question of such a scenario, from its program.
 * program_file_ranks: its ranks, where the program is made for a number of them. */
void program_file_entitle(struct scenario *s, struct arena *a);
void program_file_ranks(const struct scenario *s, struct node *root, struct arena *a);

/* program_file_collect: fill s->program with all programs that `root` and --set name; s->path and
 * dir are known. False with ERR_NO_INPUT, ERR_DATA (not a program, errors in its source, outside
 * the folder). */
bool program_file_collect(struct scenario *s, struct node *root, const struct plan_options *o,
                          struct arena *a, struct err *e);

/* program_file_key: the full key of `key`, in `a`, where a program of the scenario declares it;
 * else `key`. program_file_rename: the same for all keys of `root` where settings stand. */
const char *program_file_key(const struct scenario *s, const char *key, struct arena *a);
void program_file_rename(const struct scenario *s, struct node *root, struct arena *a);

/* program_file_unknown: refuse `key` as setting_unknown does, with parameters among what may have
 * been meant. Returns false. */
bool program_file_unknown(const struct scenario *s, const char *key, const char *file, int line,
                          struct err *e);

/* program_file_check: each setting of a parameter against its declaration. False with ERR_DATA. */
bool program_file_check(struct scenario *s, struct arena *a, struct err *e);

/* program_file_choose: what the settings of *run say of its program: kind, name, content; its n
 * becomes model.n. Does nothing for built-in programs.
 *
 *   list  in  (n) the settings of the point in the order in which they act
 *
 * program_file_parameters: the values of its parameters, when n is known. False with ERR_DATA. */
bool program_file_choose(const struct scenario *s, struct run_spec *run,
                         const struct setting_list *const *list, int n, struct err *e);
bool program_file_parameters(const struct scenario *s, struct run_spec *run,
                             const struct setting_list *const *list, int n, struct arena *a,
                             struct err *e);

#endif
