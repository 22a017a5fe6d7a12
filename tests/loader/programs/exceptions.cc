/* exceptions.cc - C++ exceptions through several frames, through sorting, and between switches of
 * ranks. */
#include <cstdio>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <cstdlib>
struct guard {
    ~guard() { std::printf("unwound\n"); }
};
static int deep(int n)
{
    guard g;
    if (n == 0) throw std::runtime_error("deep " + std::to_string(n));
    usleep(1);
    return deep(n - 1) + 1;
}
static int order(const void *a, const void *b)
{
    if (*(const int *)a == 3) throw 42;
    return *(const int *)a - *(const int *)b;
}
int main()
{
    try {
        deep(1);
    } catch (const std::exception &e) {
        std::printf("%s\n", e.what());
    }
    int x[] = {3, 1, 2};
    try {
        std::qsort(x, 3, sizeof *x, order);
    } catch (int n) {
        std::printf("%d\n", n);
    }
    try {
        try {
            throw 1;
        } catch (...) {
            usleep(1);
            throw;
        }
    } catch (int n) {
        std::printf("again %d\n", n);
    }
}
