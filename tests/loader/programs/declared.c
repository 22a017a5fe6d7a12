/* declared.c - declarations of programs, sound and wrong: which one, FORM says. */
#include <mimdsim/program.h>

static void run(struct comm *c) { (void)c; }

static int64_t count = 12;
static double wait = 2e-6;

#define TWO                                                                                        \
    .parameter = {PROGRAM_WHOLE(count, 0, 100, "how many"), PROGRAM_REAL(wait, "s", 0, 1, "time")}

#if FORM == 0
PROGRAM(.title = "A title", .run = run, TWO);
#elif FORM == 1 /* the name of a built-in program */
PROGRAM(.name = "barrier", .run = run);
int main(void) { return 3; }
#elif FORM == 2
PROGRAM(.title = "No function");
#elif FORM == 3
PROGRAM(.run = run, .tolerance = -1e-9);
#elif FORM == 4 /* one word twice */
PROGRAM(.run = run,
        .parameter = {PROGRAM_WHOLE(count, 0, 100, ""), PROGRAM_WHOLE(count, 0, 50, "")});
#elif FORM == 5 /* its default is out of its range */
PROGRAM(.run = run, .parameter = {PROGRAM_WHOLE(count, 13, 100, "")});
#elif FORM == 6 /* of another version */
const struct mimdsim_program mimdsim_program = {.magic = MIMDSIM_PROGRAM_MAGIC,
                                                .abi = MIMDSIM_PROGRAM_ABI + 1,
                                                .size = sizeof(struct mimdsim_program),
                                                .run = run};
#elif FORM == 7
int main(void) { return run == 0; }
#endif
int64_t declared_unused(void);
int64_t declared_unused(void) { return count + (int64_t)wait; }
