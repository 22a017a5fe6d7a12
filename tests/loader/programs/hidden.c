/* hidden.c - functions of the C library that keep something between calls. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <getopt.h>
#include <mimdsim/host.h>
int main(void)
{
    int me = mimdsim_host->rank;
    srand(me + 1);
    srand48(me);
    time_t t = 86400 * me;
    char text[] = "a b c";
    struct tm *b = gmtime(&t);
    char *w = strtok(text, " ");
    char *argument[] = {"x", "-n", "3", "word", "-v", NULL};
    int c = getopt(5, argument, "n:v");
    usleep(1);
    int first = rand(), second = (int)(1000 * drand48());
    w = strtok(NULL, " ");
    usleep(1);
    printf("%d %d %s %d %c%s", first % 1000, second, w, b->tm_mday, c, optarg);
    c = getopt(5, argument, "n:v");
    printf(" %c %d", c, getopt(5, argument, "n:v"));
    usleep(1);
    printf(" %d %s %s\n", optind, argument[optind], strtok(NULL, " "));
}
