#!/usr/bin/env bats
# cc.bats - mimdsim cc, c++, f90 as build systems meet them.

load helper

eval "common_$(declare -f setup)"
setup() {
    command -v gcc >/dev/null || skip "no gcc"
    common_setup
    unset MIMDSIM_CC MIMDSIM_CXX MIMDSIM_FC
    cat >one.c <<'END'
#include <math.h>
int two(int n);
int main(int argc, char **argv) { return two(argc) + (int)sin(argv[0][0]); }
END
    echo 'int two(int n) { return 2 * n; }' >two.c
}

# blocks FILE: how many counters its code has.
blocks() { objdump -d "$1" | grep -c 'lea  *0x0(%r15),%r15'; }
# entries FILE: how many entries its table has (struct block_entry, 52 bytes each).
entries() {
    echo $((0x$(readelf -SW "$1" | sed -n 's/.* mimdsim_blocks  *PROGBITS  *[0-9a-f]* [0-9a-f]* \([0-9a-f]*\) .*/\1/p') / 52))
}

@test "questions are answered by gcc" {
    for question in --version -dumpmachine -print-file-name=libm.so -print-prog-name=as; do
        works mimdsim cc "$question"
        stdout_is "$(gcc "$question")"
    done
    works mimdsim c++ --version
    stdout_is "$(g++ --version)"
    echo 'int x = __LINE__;' >line.c
    works mimdsim cc -E line.c
    stdout_is "$(gcc -E line.c)"
}

@test "objects, assembly, preprocessed files and programs have the names that gcc gives" {
    works mimdsim cc -c one.c two.c
    [ -f one.o ] && [ -f two.o ]
    works mimdsim cc -S two.c
    grep -q 'leaq 0(%r15), %r15' two.s
    works mimdsim cc -c two.s -o again.o
    [ "$(blocks again.o)" -eq "$(blocks two.o)" ]
    gcc -E two.c -o two.i
    works mimdsim cc -c two.i -o from-i.o
    works mimdsim cc one.o two.o -lm
    [ -x a.out ]
    works mimdsim cc -O2 -o prog one.c two.o -lm
    [ -x prog ]
    echo 'int two(int n) { return n; }' | mimdsim cc -x c -c - -o stdin.o
    [ "$(blocks stdin.o)" -eq 1 ]
    works mimdsim cc -c -MMD -o out.o two.c
    [ "$(cat out.d)" = "out.o: two.c" ]
}

@test "every block of an image has an entry of the table" {
    works mimdsim cc -O2 -o prog one.c two.c -lm
    [ $(($(blocks prog) + 3)) -eq "$(entries prog)" ] # guest/memory.S has three rates
    [ "$(entries prog)" -ge 3 ]
    readelf -n prog | grep -q mimdsim
}

@test "an image whose table is of other rules is refused, not read for what it is not" {
    command -v objcopy >/dev/null || skip "no objcopy"
    echo 'int main(void) { return 0; }' >three.c
    works mimdsim cc -O2 -o prog three.c
    works mimdsim mpirun -n 2 ./prog
    # the first word behind the name in the note of an object
    objcopy --dump-section .note.mimdsim=note prog
    printf '\001' | dd of=note bs=1 seek=20 conv=notrunc status=none
    objcopy --update-section .note.mimdsim=note prog old
    fails_with 65 mimdsim mpirun -n 2 ./old
    stderr_says "was made by another version of \`mimdsim cc\` (rules 1, here 5): compile it again"
}

@test "an object of another compiler is refused by name" {
    gcc -c -fPIC two.c
    works mimdsim cc -c one.c
    fails_with 65 mimdsim cc one.o two.o -lm -o prog
    stderr_says "two.o was not compiled by \`mimdsim cc\`"
    [ ! -e prog ]
    ar rc libtwo.a two.o
    fails_with 65 mimdsim cc one.o -L. -ltwo -lm -o prog
    stderr_says "two.o in ./libtwo.a was not compiled"
    rm two.o libtwo.a
    works mimdsim cc -c two.c
    ar rc libtwo.a two.o
    works mimdsim cc one.o -L. -ltwo -lm -o prog
}

@test "what an image cannot have is refused with the reason" {
    fails_with 64 mimdsim cc -march=native -c one.c
    stderr_says "depend on this computer"
    fails_with 64 mimdsim cc -fopenmp -c one.c
    stderr_says "one thread"
    echo 'long f(void) { long x; __asm__("mov %%r15, %0" : "=r"(x)); return x; }' >r15.c
    fails_with 65 mimdsim cc -c r15.c
    stderr_says "r15.c:1: register r15 is used here"
    [ ! -e r15.o ]
}

@test "without gcc, or with clang in its place, the message says what is needed" {
    mkdir empty
    fails_with 69 env PATH="$PWD/empty" "$MIMDSIM" cc -c one.c
    stderr_says "'gcc' is not installed"
    printf '#!/bin/sh\necho clang version 99\n' >fake-clang
    chmod +x fake-clang
    MIMDSIM_CC=$PWD/fake-clang fails_with 69 "$MIMDSIM" cc -c one.c
    stderr_says "works through gcc"
}

@test "messages and statuses of the compiler and the linker come through" {
    echo 'int f(void) { return nothing; }' >wrong.c
    fails_with 1 mimdsim cc -c wrong.c
    stderr_says "wrong.c:1:22: error:"
    [ ! -e wrong.o ]
    fails_with 1 mimdsim cc -o prog one.c -lm
    stderr_says "undefined reference to \`two'"
    fails_with 1 mimdsim cc -o prog two.c
    stderr_says "undefined reference to \`main'"
    [ ! -e prog ]
    fails_with 1 mimdsim cc
    stderr_says "no input files"
}

@test "compiling twice gives the same file" {
    for n in 1 2; do
        mkdir $n && cp one.c two.c $n && (cd $n && mimdsim cc -O2 -g -c one.c two.c -ffile-prefix-map="$PWD"=. &&
            mimdsim cc -O2 one.c two.c -lm -o prog -Wl,--build-id=none)
    done
    cmp 1/one.o 2/one.o
    cmp 1/two.o 2/two.o
    cmp 1/prog 2/prog
}

@test "C++ and Fortran link with their libraries" {
    command -v g++ >/dev/null && command -v gfortran >/dev/null || skip "no g++ or gfortran"
    printf '#include <iostream>\nint main() { std::cout << "hi\\n"; }\n' >hi.cc
    works mimdsim c++ -O1 hi.cc -o hi
    readelf -d hi | grep NEEDED >needed
    ! grep -q libstdc++ needed
    printf 'program p\nprint *, sin(1d0)\nend\n' >p.f90
    works mimdsim f90 -O1 p.f90 -o p
    stderr_is_empty
    readelf -d p | grep -q libgfortran
}

# A library that calls the program back has something of its own in the register that counts.
@test "functions that libraries call leave their register as it was" {
    command -v g++ >/dev/null || skip "no g++"
    cat >back.cc <<'END'
#include <mimdsim/program.h>
#include <cstdlib>
#include <new>
#include <ostream>
#include <streambuf>
#include <string>
void *operator new(std::size_t size) { if (void *p = std::malloc(size)) return p; throw std::bad_alloc(); }
void operator delete(void *p) noexcept { std::free(p); }
void operator delete(void *p, std::size_t) noexcept { std::free(p); }
struct kept : std::streambuf {
    std::string out;
    int overflow(int c) override { out.push_back((char)c); return c; }
    std::streamsize xsputn(const char *s, std::streamsize n) override { out.append(s, n); return n; }
};
static void run(struct comm *c)
{
    kept b;
    std::ostream o(&b);
    for (int i = 0; i < 100; i++) o << "abc " << 1.5 * i << std::string(20, 'x') << ' ' << i << '\n';
    double sum = 0;
    for (char x : b.out) sum = sum * 0.5 + x;
    comm_publish(c, 0, 0, 1, &sum);
}
PROGRAM(.title = "called back", .output = {"sum"}, .run = run);
END
    works mimdsim c++ -O2 back.cc -o back.so
    printf 'schema_version: 1\nquestion: does it run\nprogram: back.so\nmachine: t3e-300\nranks: 1\n' >back.yaml
    works mimdsim run back.yaml -o one.db
    works mimdsim run back.yaml -o two.db
    query="SELECT status, makespan_ps > 100000000, digest FROM run"
    [ "$(sqlite3 one.db "$query")" = "$(sqlite3 two.db "$query")" ]
    [[ $(sqlite3 one.db "$query") == "ok|1|"* ]]
}

# gcc would keep k in a register that twice leaves alone; its entry needs that one.
@test "values that are kept across calls survive entries" {
    cat >kept.c <<'END'
#include <stdio.h>
__attribute__((noinline)) int twice(int x) { return 2 * x; }
__attribute__((noinline)) int mixed(const int *v)
{
    int a = v[0], b = v[1], c = v[2], d = v[3], e = v[4], f = v[5], g = v[6], h = v[7], i = v[8], j = v[9], k = v[10];
    int s = twice(a);
    return s + a * b + c * d + e * f + g * h + i * j + k * s + (a ^ c ^ e ^ g ^ i ^ k) + (b | d | f | h | j);
}
int main(int argc, char **argv)
{
    int v[11];
    for (int i = 0; i < 11; i++) v[i] = argc * (i + 3) * 7 % 31;
    printf("%d %d\n", mixed(v), argv[1] != 0);
    return 0;
}
END
    for level in -O1 -O2 -O3; do
        works mimdsim cc $level kept.c -o kept
        works ./kept
        stdout_is "2727 0"
    done
}

@test "host time as the cost is taken" {
    cat >sum.c <<'END'
#include <mimdsim/program.h>
static void run(struct comm *c)
{
    double sum = 0;
    for (int i = 1; i < 1000000; i++) sum += 1.0 / i;
    comm_publish(c, 0, 0, 1, &sum);
}
PROGRAM(.title = "sum", .output = {"sum"}, .run = run);
END
    works mimdsim cc -O2 sum.c -o sum.so
    printf 'schema_version: 1\nquestion: how long\nprogram: sum.so\nmachine: t3e-300\nranks: 1\n' >sum.yaml
    works mimdsim run sum.yaml -o sum.db --set program.cost=blocks,author,host
    # 1e6 of a division of 23 cycles at 300 MHz and an addition at 55 Mflop/s are 94.8 ms
    sql_is sum.db "SELECT round(makespan_ps / 1e8) FROM run ORDER BY makespan_ps DESC LIMIT 1" 948.0
    sql_is sum.db "SELECT count(*) FROM run WHERE makespan_ps > 1e8" 2
}

@test "a program states what its computing costs" {
    cat >state.c <<'END'
#ifdef __MIMDSIM__
#include <mimdsim/compute.h>
#endif
int main(void)
{
    for (volatile int i = 0; i < 1000; i++) continue;
    mimdsim_compute(55e6, 0);
    mimdsim_compute(0, 300e6);
    return 0;
}
END
    works mimdsim cc state.c -o state
    works mimdsim mpirun -n 1 -m t3e-300 --set program.cost=author ./state
    stderr_says "t3e-300: 1.5 s" # a second at 55 Mflop/s, a half at 600 MB/s
    printf 'program p\nexternal mimdsim_compute\ncall mimdsim_compute(110d6, 0d0)\nend\n' >state.f90
    works mimdsim f90 state.f90 -o state-f90
    works mimdsim mpirun -n 1 -m t3e-300 --set program.cost=author ./state-f90
    stderr_says "t3e-300: 2 s"
    works mimdsim mpirun -n 1 -m t3e-300 ./state
    [[ $stderr == *e-05\ s* ]]
}

@test "mimdsim-cc is mimdsim cc in one word" {
    works "${MIMDSIM%/*}/mimdsim-cc" --version
    stdout_is "$(gcc --version)"
    works "${MIMDSIM%/*}/mimdsim-cc" -O2 one.c two.c -lm -o prog
    [ "$(blocks prog)" -ge 3 ]
}

@test "an image that is executed runs on one virtual processor" {
    printf '#include <stdio.h>\nint main(int n, char **v) { printf("%%d %%s\\n", n, v[n - 1]); return 3; }\n' >say.c
    works mimdsim cc -O1 -fvisibility=hidden say.c -o say
    fails_with 3 ./say -x "two words"
    stdout_is "3 two words"
    cp say elsewhere
    fails_with 3 env MIMDSIM_DATA= ./elsewhere
}

@test "blocks of libraries that mimdsim cc made are counted, too" {
    cat >sum.c <<'END'
double sum(int n);
double sum(int n)
{
    double s = 0;
    for (int i = 1; i < n; i++) s += 1.0 / i;
    return s;
}
END
    printf '#include <stdio.h>\ndouble sum(int n);\nint main(void) { printf("%%.3f\\n", sum(1000000)); }\n' >main.c
    works mimdsim cc -O2 -shared sum.c -o libsum.so
    works mimdsim cc -O2 main.c -L. -lsum -Wl,-rpath,"$PWD" -o with-library
    works mimdsim cc -O2 main.c sum.c -o without
    for program in with-library without; do # 1e6 of 23 cycles at 300 MHz and a flop at 55 Mflop/s are 94.8 ms
        works mimdsim mpirun -n 1 -m t3e-300 ./$program
        stdout_is 14.393
        stderr_says "t3e-300: 0.0948"
    done
}

@test "make's own rules and CMake's toolchain build a project" {
    printf 'prog: one.o two.o\n\t$(CC) $(CFLAGS) -o $@ $^ -lm\n' >Makefile
    make -s CC="$MIMDSIM cc" CFLAGS=-O1
    [ -x prog ]
    command -v cmake >/dev/null || return 0
    mkdir cmake && mv one.c two.c cmake && cd cmake
    cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.10)
project(t C)
include(CheckFunctionExists)
check_function_exists(strdup HAVE_STRDUP)
check_function_exists(no_such_function HAVE_NO_SUCH_FUNCTION)
include(CheckCSourceRuns)
check_c_source_runs("int main(void) { return 0; }" RUNS)
check_c_source_runs("int main(void) { return 1; }" FAILS)
add_library(two SHARED two.c)
add_executable(t one.c)
target_link_libraries(t two m)
file(WRITE answers "${HAVE_STRDUP} ${RUNS} ${FAILS}${HAVE_NO_SUCH_FUNCTION}")
END
    cmake -DCMAKE_TOOLCHAIN_FILE="$MIMDSIM_SRCDIR/share/mimdsim.cmake" -DMIMDSIM_FOLDER="${MIMDSIM%/*}" . >log 2>&1
    [ "$(cat answers)" = "1 1 " ]
    make -s >>log 2>&1
    [ -x t ] && readelf -n libtwo.so | grep -q mimdsim
}
