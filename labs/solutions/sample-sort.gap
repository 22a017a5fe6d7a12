        for (int i = 1; i < p; i++) splitter[i - 1] = sample[i * p];
        for (int i = 1; i < p; i++) comm_send(c, i, 1, splitter, (p - 1) * 8);
