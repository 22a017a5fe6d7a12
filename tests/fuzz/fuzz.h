/* fuzz.h - what the harnesses share: one input each, in memory or as a file, and what a refusal
 * must be like.
 *
 * A harness is one file that defines LLVMFuzzerTestOneInput. Linked with libFuzzer it searches for
 * inputs that break the program; linked with replay.c it runs over the corpus in every `make
 * check`. */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/check.h"
#include "base/err.h"

/* What one input may cost: docs/reliability.md states these. */
enum { FUZZ_SECONDS = 1, FUZZ_MEGABYTES = 1024 };

/* What libFuzzer calls. LLVMFuzzerTestOneInput: run one input; returns 0, or -1: not worth keeping.
 */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
/* LLVMFuzzerCustomMutator: change `data` in place to something of at most `most` bytes; returns its
 * size. Text harnesses define it as text_mutate. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);
/* LLVMFuzzerMutate: libFuzzer's own changes of bytes; replay.c has one that does nothing. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);

/* fuzz_allow: this input may take `seconds` instead: it asks for work that the documentation
 * states. Holds until the next input. fuzz_allowed: how long that is. */
void fuzz_allow(double seconds);
double fuzz_allowed(void);

/* fuzz_whole: whether the next inputs are files of the corpus, of which everything is tried,
 * however long it takes; fuzz_is_whole tells. Otherwise, and under libFuzzer, a harness may try a
 * part that follows from the input. */
void fuzz_whole(bool whole);
bool fuzz_is_whole(void);

/* fuzz_choice: a number that follows from the input's bytes, to choose such a part by. */
size_t fuzz_choice(const uint8_t *data, size_t size);

/* fuzz_file: write the input to file `name` in a folder of this process, in memory where the system
 * has such; returns its path. The folder is removed when the process ends. */
const char *fuzz_file(const char *name, const void *data, size_t size);

/* fuzz_folder: that folder. */
const char *fuzz_folder(void);

/* fuzz_data: the folder of machines, scenarios and figures: MIMDSIM_DATA, else the source tree. To
 * be called before the first plan is read. */
void fuzz_data(void);

/* fuzz_refused: a refusal has a kind of bad input and says why. */
void fuzz_refused(const struct err *e);

/* fuzz_text: the input as a string with an end, on the heap. Bytes behind a zero are lost, as on a
 * command line. */
char *fuzz_text(const uint8_t *data, size_t size);

/* fuzz_sink: where output goes that nobody reads. */
void *fuzz_sink(void);

/* Numbers out of the bytes of an input; an exhausted input gives zeros. */
struct fuzz_bytes {
    const uint8_t *at, *end;
};

/* fuzz_take: the next n <= 8 bytes as a number. */
uint64_t fuzz_take(struct fuzz_bytes *b, int n);

/* fuzz_below: the next byte or two as a number below n <= 65536. */
unsigned fuzz_below(struct fuzz_bytes *b, unsigned n);

/* text_mutate: a change that keeps files readable: a number becomes one that hurts, a word another
 * word of the file, a line is repeated, removed or exchanged, a part in brackets is removed or
 * repeated; half of the time libFuzzer's own changes of bytes. */
size_t text_mutate(uint8_t *data, size_t size, size_t most, unsigned seed);

#endif
