    for (int i = 0; i < segments; i++) {
        char *piece = message + i * m;
        if (me > 0) MPI_Recv(piece, m, MPI_BYTE, me - 1, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (me < p - 1) MPI_Send(piece, m, MPI_BYTE, me + 1, 0, MPI_COMM_WORLD);
    }
