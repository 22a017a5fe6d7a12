        const int have = (mine - step + Q) % Q, come = (have - 1 + Q) % Q;
        MPI_Sendrecv(all + have * NUMBERS, NUMBERS, MPI_DOUBLE, next, step, all + come * NUMBERS,
                     NUMBERS, MPI_DOUBLE, last, step, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
