/* elementary_list.h - functions of libraries whose work is known from their name: one line each.
 *
 * What a call of them counts, beside the call itself; their own code is the library's and has no
 * counted blocks. Columns of X: name without the ending f or l of its type, flop, div, sqrt, trig.
 * One trig is one evaluation of sine, cosine, exponential or the like. Complex division is Smith's
 * (three divisions, three products, three sums), pow an exponential and a logarithm. */
#ifndef COMPILE_ELEMENTARY_LIST_H
#define COMPILE_ELEMENTARY_LIST_H

#define ELEMENTARY_LIST(X)                                                                         \
    X("sin", 0, 0, 0, 1)                                                                           \
    X("cos", 0, 0, 0, 1)                                                                           \
    X("tan", 0, 0, 0, 1)                                                                           \
    X("asin", 0, 0, 0, 1)                                                                          \
    X("acos", 0, 0, 0, 1)                                                                          \
    X("atan", 0, 0, 0, 1)                                                                          \
    X("atan2", 0, 1, 0, 1)                                                                         \
    X("sincos", 0, 0, 0, 2)                                                                        \
    X("sinh", 0, 0, 0, 1)                                                                          \
    X("cosh", 0, 0, 0, 1)                                                                          \
    X("tanh", 0, 0, 0, 1)                                                                          \
    X("asinh", 0, 0, 0, 1)                                                                         \
    X("acosh", 0, 0, 0, 1)                                                                         \
    X("atanh", 0, 0, 0, 1)                                                                         \
    X("exp", 0, 0, 0, 1)                                                                           \
    X("exp2", 0, 0, 0, 1)                                                                          \
    X("exp10", 0, 0, 0, 1)                                                                         \
    X("expm1", 0, 0, 0, 1)                                                                         \
    X("log", 0, 0, 0, 1)                                                                           \
    X("log2", 0, 0, 0, 1)                                                                          \
    X("log10", 0, 0, 0, 1)                                                                         \
    X("log1p", 0, 0, 0, 1)                                                                         \
    X("pow", 0, 0, 0, 2)                                                                           \
    X("cbrt", 0, 0, 0, 1)                                                                          \
    X("erf", 0, 0, 0, 1)                                                                           \
    X("erfc", 0, 0, 0, 1)                                                                          \
    X("tgamma", 0, 0, 0, 2)                                                                        \
    X("lgamma", 0, 0, 0, 2)                                                                        \
    X("j0", 0, 0, 0, 2)                                                                            \
    X("j1", 0, 0, 0, 2)                                                                            \
    X("y0", 0, 0, 0, 2)                                                                            \
    X("y1", 0, 0, 0, 2)                                                                            \
    X("cexp", 2, 0, 0, 3)                                                                          \
    X("clog", 3, 0, 1, 2)                                                                          \
    X("cpow", 6, 0, 1, 5)                                                                          \
    X("csin", 2, 0, 0, 4)                                                                          \
    X("ccos", 2, 0, 0, 4)                                                                          \
    X("carg", 0, 1, 0, 1)                                                                          \
    X("csqrt", 4, 1, 2, 0)                                                                         \
    X("cabs", 3, 0, 1, 0)                                                                          \
    X("hypot", 3, 0, 1, 0)                                                                         \
    X("sqrt", 0, 0, 1, 0)                                                                          \
    X("fma", 2, 0, 0, 0)                                                                           \
    X("fmin", 1, 0, 0, 0)                                                                          \
    X("fmax", 1, 0, 0, 0)                                                                          \
    X("fmod", 1, 1, 0, 0)                                                                          \
    X("remainder", 1, 1, 0, 0)                                                                     \
    X("__muldc3", 6, 0, 0, 0)                                                                      \
    X("__mulsc3", 6, 0, 0, 0)                                                                      \
    X("__divdc3", 6, 3, 0, 0)                                                                      \
    X("__divsc3", 6, 3, 0, 0)                                                                      \
    X("__divti3", 0, 1, 0, 0)                                                                      \
    X("__udivti3", 0, 1, 0, 0)                                                                     \
    X("__modti3", 0, 1, 0, 0)                                                                      \
    X("__umodti3", 0, 1, 0, 0)

#endif
