/* processor.h - what this host's processor can do beyond the instructions that all of them have.
 *
 * The C library has asked the processor before the program begins. The compiler's own
 * __builtin_cpu_supports asks again in every start, which on a virtual machine, where each question
 * goes to its host, takes a hundredth of a small run. */
#ifndef BASE_PROCESSOR_H
#define BASE_PROCESSOR_H

#include <stdbool.h>

#ifdef __x86_64__
#if __has_include(<sys/platform/x86.h>)
#include <sys/platform/x86.h>
#define PROCESSOR_HAS(ours, theirs) CPU_FEATURE_ACTIVE(ours)
#else
#define PROCESSOR_HAS(ours, theirs) __builtin_cpu_supports(theirs)
#endif

/* processor_has_avx2, processor_has_avx512f: whether registers of 256 and of 512 bits can be used:
 * the processor has them, and the system keeps them. */
static inline bool processor_has_avx2(void) { return PROCESSOR_HAS(AVX2, "avx2"); }
static inline bool processor_has_avx512f(void) { return PROCESSOR_HAS(AVX512F, "avx512f"); }
#undef PROCESSOR_HAS
#endif

#endif
