        for (int i = 1; i < P; i++) splitter[i - 1] = sample[i * P];
        for (int i = 1; i < P; i++)
            MPI_Send(splitter, P - 1, MPI_DOUBLE, i, 1, MPI_COMM_WORLD);
