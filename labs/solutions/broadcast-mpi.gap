    int distance = 1;
    /* The highest bit of the own number is the round in which the message comes. */
    while (2 * distance <= me) distance *= 2;
    if (me > 0)
        MPI_Recv(message, BYTES, MPI_BYTE, me - distance, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    for (int d = me > 0 ? 2 * distance : 1; me + d < p; d *= 2)
        MPI_Send(message, BYTES, MPI_BYTE, me + d, 0, MPI_COMM_WORLD);
