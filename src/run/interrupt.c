/* interrupt.c - what a campaign says when somebody ends it by Ctrl-C or SIGTERM.
 *
 * Each run is stored in a transaction of its own, so nothing has to be put in order: only people
 * want to know that. The handler calls what POSIX allows in handlers, and the signal then does
 * what it does without it. */
#include "run/interrupt.h"

#include <unistd.h>

static void say(int number)
{
    static const char text[] =
        "\nmimdsim: interrupted: what is stored stays, and the same command goes on from there\n";
    (void)!write(STDERR_FILENO, text, sizeof text - 1);
    /* It is blocked until this returns, and the handler is gone by then (SA_RESETHAND). */
    raise(number);
}

static void hear(int number, struct sigaction *before)
{
    struct sigaction action = {.sa_handler = say, .sa_flags = (int)SA_RESETHAND};
    sigaction(number, NULL, before);
    if (before->sa_handler == SIG_DFL) sigaction(number, &action, NULL);
}

void interrupts_begin(struct interrupts *before)
{
    hear(SIGINT, &before->interrupt);
    hear(SIGTERM, &before->terminate);
}

void interrupts_end(const struct interrupts *before)
{
    sigaction(SIGINT, &before->interrupt, NULL);
    sigaction(SIGTERM, &before->terminate, NULL);
}

/* Ctrl-C reaches all processes of the terminal. */
void interrupts_silent(void)
{
    struct interrupts mine;
    sigaction(SIGINT, NULL, &mine.interrupt);
    sigaction(SIGTERM, NULL, &mine.terminate);
    if (mine.interrupt.sa_handler == say) signal(SIGINT, SIG_DFL);
    if (mine.terminate.sa_handler == say) signal(SIGTERM, SIG_DFL);
}
