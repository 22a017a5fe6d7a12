// sums.cpp - C++ on ranks: exceptions, containers, statics of functions and templates, a destructor at the end.
#include <mpi.h>

#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

template <class T> struct Counted {
    static inline int made = 0;
    T value;
    explicit Counted(T v) : value(v) { made++; }
};

static int caught(int rank)
{
    static int calls = 0;
    calls++;
    try {
        if (rank >= 0) throw std::runtime_error("rank " + std::to_string(rank));
    } catch (const std::exception &e) {
        return e.what() == "rank " + std::to_string(rank) ? calls : 0;
    }
    return 0;
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    int rank, ranks, all = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    int own = caught(rank);
    MPI_Reduce(&own, &all, 1, MPI_INT, MPI_SUM, 0, MPI_COMM_WORLD);
    std::map<int, std::vector<double>> rows;
    std::vector<std::unique_ptr<Counted<int>>> some;
    for (int i = 0; i <= rank; i++) {
        rows[i % 2].push_back(i);
        some.push_back(std::make_unique<Counted<int>>(i));
    }
    double sum = 10.0 * (Counted<int>::made - 1), total = 0;
    MPI_Allreduce(&sum, &total, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0) std::printf("%d ranks, %d caught, sum %g\n", ranks, all, total);
    MPI_Finalize();
    return rows[0].size() + rows[1].size() == some.size() ? 0 : 1;
}
