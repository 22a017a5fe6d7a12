/* crash.c - ways to crash, by the first argument, on rank 1 alone. */
#include <mimdsim/host.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static volatile int zero;
static char *volatile nowhere;

static void compute(void) { *nowhere = 1; } /* line 11 */
static int divide(void) { return 7 / zero; }
static int deep(int n)
{
    volatile char block[10000];
    block[n % 10000] = (char)n;
    return deep(n + 1) + block[n % 10000];
}
static void spin(void)
{
    for (;;) zero = 0; /* line 21 */
}
static void in_library(void) { memset(nowhere, zero, 100000); }

int main(int argc, char **argv)
{
    usleep(5);
    if (mimdsim_host->rank != 1 || argc < 2) return 0;
    switch (argv[1][0]) {
    case 'n': compute(); break;
    case 'd': return divide();
    case 's': return deep(0);
    case 'l': spin(); break;
    case 'm': in_library(); break;
    case 'i': __builtin_trap();
    case 'f': {
        char *volatile p = malloc(100);
        free(p);
        free(p);
        break;
    }
    }
    return 0;
}
