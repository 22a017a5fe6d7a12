/* statics.cc - C++ variables of which the linker keeps one: inline, of templates, in inline
 * functions. */
#include <cstdio>
#include <unistd.h>
#include <mimdsim/host.h>
struct a {
    static inline int n = 1;
};
template <class T> struct b {
    static T n;
};
template <class T> T b<T>::n = 2;
inline int &c()
{
    static int n = 3;
    return n;
}
inline int d = 4;
int main()
{
    int me = mimdsim_host->rank;
    for (int i = 0; i < 2; i++) {
        a::n += me;
        b<int>::n += me;
        c() += me;
        d += me;
        usleep(1);
    }
    std::printf("%d %d %d %d\n", a::n, b<int>::n, c(), d);
}
