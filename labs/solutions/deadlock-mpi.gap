    if (me % 2 == 0) {
        MPI_Ssend(&own, 1, MPI_DOUBLE, next, 0, MPI_COMM_WORLD);
        MPI_Recv(&got, 1, MPI_DOUBLE, last, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    } else {
        MPI_Recv(&got, 1, MPI_DOUBLE, last, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        MPI_Ssend(&own, 1, MPI_DOUBLE, next, 0, MPI_COMM_WORLD);
    }
