/* refused.c - what a program on the simulator cannot do, by the first argument. */
#include <assert.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static void *nothing(void *x) { return x; }

static int be_bad(const char *what)
{
    char line[100];
    pthread_t t;
    if (!strcmp(what, "fork")) return fork();
    if (!strcmp(what, "exec")) return execlp("ls", "ls", NULL);
    if (!strcmp(what, "system")) return system("true");
    if (!strcmp(what, "popen")) return popen("true", "r") != NULL;
    if (!strcmp(what, "thread")) return pthread_create(&t, NULL, nothing, NULL);
    if (!strcmp(what, "socket")) return socket(AF_INET, SOCK_STREAM, 0);
    if (!strcmp(what, "stdin")) return fgets(line, sizeof line, stdin) != NULL;
    if (!strcmp(what, "scanf")) return scanf("%s", line);
    if (!strcmp(what, "outside")) return fopen("../../outside.txt", "w") != NULL;
    if (!strcmp(what, "passwd")) return open("/etc/passwd", O_RDWR);
    if (!strcmp(what, "assert")) assert(what[0] == 'b');
    if (!strcmp(what, "abort")) abort();
    return 0;
}

int main(int argc, char **argv)
{
    FILE *f = fopen("/etc/hosts", "r"); /* reading is free */
    printf("before %d\n", f != NULL && argc == 2);
    return be_bad(argv[1]);
}
