#!/usr/bin/env bats
# mpi_programs.bats - MPI programs in C, C++ and Fortran, compiled by mimdsim and run; other people's where
# MIMDSIM_PROGRAMS names a folder with their sources.

load helper
load programs.bash

programs="$MIMDSIM_SRCDIR/tests/mpi/programs"

# have COMMAND: skips where it is not there.
have() { command -v "$1" >there || skip "no $1"; }

@test "Fortran: the module, mpif.h, statuses, texts, signs for nothing, operations of its own" {
    have gfortran
    works mimdsim f90 -O2 -o ring "$programs/ring.f90"
    stderr_is_empty
    for n in 1 2 5; do
        works mimdsim mpirun -q -n "$n" ./ring
        stdout_says "ring of $n ranks is right"
    done
}

@test "C++: exceptions, containers and static objects of each rank's own" {
    have g++
    works mimdsim c++ -O2 -o sums "$programs/sums.cpp"
    works mimdsim mpirun -q -n 4 ./sums
    stdout_says "4 ranks, 4 caught, sum 60"
}

@test "C: the same answer whatever the compiler's level, and the same times in every run" {
    have gcc
    for level in -O0 -O1 -O2 -O3; do
        works mimdsim cc $level -o halo "$programs/halo.c" -lm
        works mimdsim mpirun -q -n 8 ./halo 2 2 2
        stdout_says "halo 2 x 2 x 2 is right"
    done
    works mimdsim mpirun -n 8 ./halo 2 2 2
    first=$stderr
    works mimdsim mpirun -n 8 ./halo 2 2 2
    [ "$first" = "$stderr" ]
}

# theirs NAME: a copy of a program's sources to build in; skips where there is none.
theirs() {
    [ -n "${MIMDSIM_PROGRAMS-}" ] && [ -d "$MIMDSIM_PROGRAMS/$1" ] || skip "no sources of $1 in MIMDSIM_PROGRAMS"
    have make
    cp -r "$MIMDSIM_PROGRAMS/$1" theirs
}

@test "HPCCG: the residual of eight ranks" {
    theirs HPCCG
    works make -C theirs -s CXX="$MIMDSIM c++" LINKER="$MIMDSIM c++" USE_MPI=-DUSING_MPI
    works mimdsim mpirun -q -n 8 theirs/test_HPCCG 12 12 12
    stdout_says "Final residual: 3.80498e-39"
}

@test "CoMD: the energy after twenty steps" {
    theirs CoMD
    cp theirs/src-mpi/Makefile.vanilla theirs/src-mpi/Makefile
    ln -s "$MIMDSIM" mimdsim-cc
    works make -C theirs/src-mpi -s CC="$PWD/mimdsim-cc"
    works mimdsim mpirun -q -n 8 theirs/bin/CoMD-mpi -i 2 -j 2 -k 2 -x 12 -y 12 -z 12 -N 20 -n 10
    stdout_says "-1.166048388020"
}
