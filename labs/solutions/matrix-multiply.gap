        const int have = (mine - step + q) % q, come = (have - 1 + q) % q;
        comm_send(c, next, step, all + have * numbers, numbers * 8);
        comm_recv(c, last, step, all + come * numbers, numbers * 8);
