/* vectors.c - mathematics by vectors, which libmvec has where the compiler takes it. */
#include <math.h>
#include <stdio.h>

int main(void)
{
    static double x[64];
    double sum = 0;
    for (int i = 0; i < 64; i++) x[i] = sin(0.1 * i) * exp(-0.01 * i);
    for (int i = 0; i < 64; i++) sum += x[i];
    printf("%.9f\n", sum);
}
