        if (me + d < p) MPI_Send(&own, 4, MPI_DOUBLE, me + d, d, MPI_COMM_WORLD);
        if (me - d >= 0) MPI_Send(&own, 4, MPI_DOUBLE, me - d, d, MPI_COMM_WORLD);
        if (me - d >= 0)
            MPI_Recv(&below, 4, MPI_DOUBLE, me - d, d, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (me + d < p)
            MPI_Recv(&above, 4, MPI_DOUBLE, me + d, d, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
