/* control.c - C that makes a compiler use all its ways of going elsewhere; guest() returns a
 * checksum. */
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

enum { N = 12 };

static __thread int private_count;
__thread long shared_count;
int values[N];
double matrix[N][N];

__attribute__((noinline)) static int chosen(int i)
{
    switch (i) { /* a table of jumps */
    case 0: return values[3] + 5;
    case 1: private_count++; return 17;
    case 2: return values[i] * 3;
    case 3: shared_count += i; /* fall through */
    case 4: return values[4] ^ 85;
    case 5: return private_count;
    case 6: values[6]--; return -4;
    case 7: return (int)shared_count;
    default: return i / 3;
    }
}

__attribute__((noinline)) static int interpreted(const unsigned char *code)
{
    static const void *const label[] = {&&add, &&twice, &&back, &&end};
    int sum = 1, left = 3;
    goto *label[*code];
add:
    sum += 7;
    goto *label[*++code];
twice:
    sum *= 2;
    goto *label[*++code];
back:
    if (left-- > 0) code -= 2;
    else code++;
    goto *label[*code];
end:
    return sum;
}

__attribute__((noinline)) static long added(int n, ...)
{
    va_list a;
    long sum = 0;
    va_start(a, n);
    for (int i = 0; i < n; i++) sum += i % 2 ? (long)va_arg(a, double) : va_arg(a, int);
    va_end(a);
    return sum;
}

__attribute__((noinline)) static int fibonacci(int n)
{
    return n < 2 ? n : fibonacci(n - 1) + fibonacci(n - 2);
}

__attribute__((noinline, cold)) static int seldom(int i) { return i + 1000; }

/* The carry of one addition into the next: flags that live across a counter. */
__attribute__((noinline)) static uint64_t wide(uint64_t x)
{
    unsigned __int128 sum = x;
    for (int i = 0; i < N; i++) {
        sum = sum * 3 + UINT64_MAX;
        if (__builtin_expect(sum >> 100 == 77, 0)) sum += seldom(i);
    }
    return (uint64_t)(sum >> 64) ^ (uint64_t)sum;
}

__attribute__((noinline)) static unsigned halved(unsigned n)
{
    unsigned rounds = 0;
    __asm__ goto("shrl %0\n\tjz %l[none]" : : "r"(n) : "cc" : none);
    __asm__("addl $3, %0\n\tadcl $0, %1" : "+r"(rounds), "+r"(n) : : "cc");
    return rounds + n;
none:
    return 9;
}

__attribute__((noinline)) static double product(void)
{
    double sum = 0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) matrix[i][j] = (i + 1.0) / (j + 2.0);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            double dot = 0;
            for (int k = 0; k < 4; k++) dot += matrix[i][k] * matrix[k][j];
            sum += dot < 1.5 ? dot : -dot;
        }
    return sum;
}

static int by_seven(int i) { return i * 7; }
static int less_two(int i) { return i - 2; }

long guest(void);
long guest(void)
{
    int (*const step[])(int) = {by_seven, less_two, seldom};
    static const unsigned char code[] = {0, 1, 2, 0, 3};
    struct { char byte[72]; } from = {{1}}, to;
    private_count = 0;
    shared_count = 0;
    for (int i = 0; i < N; i++) values[i] = i * i;
    long sum = interpreted(code) + added(4, 3, 2.5, 8, 1.25) + fibonacci(7) + (long)product();
    for (int i = 0; i < N; i++)
        sum = 3 * sum + chosen(i % 9) + step[i % 3](i) + (long)halved((unsigned)i);
    from.byte[71] = (char)sum;
    memcpy(&to, &from, sizeof to);
    return sum + to.byte[71] + (long)(wide((uint64_t)sum) % 1000003);
}
