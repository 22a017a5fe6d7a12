    const int me = comm_rank(c), p = comm_size(c);
    int distance = 1;
    /* The highest bit of the own number is the round in which the message comes. */
    while (2 * distance <= me) distance *= 2;
    if (me > 0) comm_recv(c, me - distance, 0, message, bytes);
    for (int d = me > 0 ? 2 * distance : 1; me + d < p; d *= 2)
        comm_send(c, me + d, 0, message, bytes);
