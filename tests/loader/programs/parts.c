/* parts.c - a program to look at: a patched constant, a section of its own, calls with arguments
 * and exits. */
#include <mimdsim/host.h>
#include <stdlib.h>

const int constant = 17;
__attribute__((section("own_section"), used)) const unsigned char own[5] = {1, 2, 3, 4, 5};
static int calls;

int get_constant(void) { return *(volatile const int *)&constant; }
long sum(long a, long b, long c, long d)
{
    calls++;
    return 1000 * calls + a + b + c + d;
}
long weighted(long a, long b, long c, long d, long e, long f)
{
    return a + 2 * b + 3 * c + 4 * d + 5 * e + 6 * f;
}
/* As counted blocks do, in a program that nobody has told to keep the register. */
void count(long n) { __asm__ volatile("lea (%%r15,%0), %%r15" : : "r"(n)); }
void leave(int status) { exit(status); }
int main(void) { return mimdsim_host->rank; }
