        const int left = (column + Q - 1) % Q, right = (column + 1) % Q;
        const int above = (row + Q - 1) % Q, below = (row + 1) % Q;
        MPI_Sendrecv_replace(a, M * M, MPI_DOUBLE, row * Q + left, 0, row * Q + right, 0,
                             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        MPI_Sendrecv_replace(b, M * M, MPI_DOUBLE, above * Q + column, 1, below * Q + column, 1,
                             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
