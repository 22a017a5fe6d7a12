/* globals.c - variables of every kind, written by all ranks in turn. */
#include <stdio.h>
#include <unistd.h>
#include <mimdsim/host.h>
int zeroed[100];
int set = 7;
static int hidden;
int *pointer = &set;
const char *text[] = {"a", "b"};
_Thread_local int local = 5;
static _Thread_local char block[100];
static int calls(void)
{
    static int n;
    return ++n;
}
int main(int argc, char **argv)
{
    int me = mimdsim_host->rank;
    for (int i = 0; i < 3; i++) {
        zeroed[50] += me + 1;
        set += me;
        hidden += 10 * me;
        *pointer += 1;
        local += me;
        block[99] += (char)(1 + me);
        calls();
        usleep(1);
    }
    printf("%d %d %d %d %d %d %s %d %s\n", zeroed[50], set, hidden, local, block[99], calls(),
           text[me], argc, argv[0]);
    return me;
}
