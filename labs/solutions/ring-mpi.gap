        MPI_Recv(token, bytes, MPI_BYTE, me - 1, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        token[0] += 1;
        MPI_Send(token, bytes, MPI_BYTE, (me + 1) % p, 0, MPI_COMM_WORLD);
