        double lower = 0;
        if (me + d < p) MPI_Send(&sum, 1, MPI_DOUBLE, me + d, d, MPI_COMM_WORLD);
        if (me >= d)
            MPI_Recv(&lower, 1, MPI_DOUBLE, me - d, d, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        sum += lower;
