        if (me > 0) {
            MPI_Irecv(x, N, MPI_DOUBLE, me - 1, 1, MPI_COMM_WORLD, &r[0]);
            MPI_Isend(x + N, N, MPI_DOUBLE, me - 1, 2, MPI_COMM_WORLD, &r[2]);
        }
        if (me < p - 1) {
            MPI_Irecv(x + (m + 1) * N, N, MPI_DOUBLE, me + 1, 2, MPI_COMM_WORLD, &r[1]);
            MPI_Isend(x + m * N, N, MPI_DOUBLE, me + 1, 1, MPI_COMM_WORLD, &r[3]);
        }
