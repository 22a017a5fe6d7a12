/* boxes.h - a template and an inline function that two files share, so that the linker keeps one of
 * each. */
#ifndef BOXES_H
#define BOXES_H

template <typename T> struct box {
    T value;
    static inline int made = 0;
    __attribute__((noinline)) explicit box(T v) : value(v) { made++; }
    __attribute__((noinline)) T squared() const
    {
        T sum = 0;
        for (T i = 0; i < value; i++) sum += value;
        return sum;
    }
};

__attribute__((noinline)) inline long boxed(long n)
{
    return box<long>(n).squared() + box<int>(3).squared();
}

long other_boxes(long n);

#endif
