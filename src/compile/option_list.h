/* option_list.h - the options of gcc that a driver around it must know: all others pass through
 * untouched.
 *
 * OPTION_WORD_LIST: options whose value is the next word; what stands for "the next word is no
 * source file". OPTION_DROPPED_LIST: options without meaning for an image that is compiled through
 * assembly and always is a shared object; they are left out. A name that ends in '*' means all that
 * begin so. OPTION_REFUSED_LIST: option, and why it cannot be. */
#ifndef COMPILE_OPTION_LIST_H
#define COMPILE_OPTION_LIST_H

#define OPTION_WORD_LIST(X)                                                                        \
    X("-o")                                                                                        \
    X("-x")                                                                                        \
    X("-I") X("-D") X("-U") X("-L") X("-l") X("-B") X("-J") X("-T") X("-u") X("-z") X("-e")        \
        X("-h") X("-A") X("-G") X("-aux-info") X("-include") X("-imacros") X("-isystem")           \
            X("-idirafter") X("-iprefix") X("-iwithprefix") X("-iwithprefixbefore") X("-iquote")   \
                X("-isysroot") X("-imultilib") X("-imultiarch") X("-MF") X("-MT") X("-MQ")         \
                    X("-Xlinker") X("-Xassembler") X("-Xpreprocessor") X("-dumpbase")              \
                        X("-dumpbase-ext") X("-dumpdir") X("-specs") X("--param") X("-wrapper")    \
                            X("-V") X("-b")

#define OPTION_DROPPED_LIST(X)                                                                     \
    X("-pipe")                                                                                     \
    X("-pie")                                                                                      \
    X("-no-pie") X("-static-pie") X("-static") X("-flto*") X("-fno-lto") X("-ffat-lto-objects")    \
        X("-fno-fat-lto-objects") X("-fuse-linker-plugin") X("-save-temps*") X("-gsplit-dwarf")

#define OPTION_REFUSED_LIST(X)                                                                     \
    X("-march=native", "the code would depend on this computer; name an architecture")             \
    X("-mtune=native", "the code would depend on this computer; name a processor")                 \
    X("-mcpu=native", "the code would depend on this computer; name a processor")                  \
    X("-fopenmp", "a virtual processor has one thread")                                            \
    X("-fopenacc", "a virtual processor has no accelerator")                                       \
    X("-ftree-parallelize-loops=*", "a virtual processor has one thread")                          \
    X("-fsanitize=*", "sanitizers need the address space of a whole process")                      \
    X("-fsplit-stack", "virtual processors have stacks of their own")                              \
    X("-pg", "the profiler's timer knows nothing of simulated time; see `mimdsim timeline`")       \
    X("-masm=intel", "computing time is counted in assembly of AT&T syntax")                       \
    X("-m32", "images are of x86-64 code")                                                         \
    X("-mx32", "images are of x86-64 code")                                                        \
    X("-m16", "images are of x86-64 code")                                                         \
    X("-fcall-used-r15", "register r15 counts computing time")                                     \
    X("-fcall-saved-r15", "register r15 counts computing time")

#endif
