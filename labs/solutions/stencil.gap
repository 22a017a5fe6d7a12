        if (me > 0) comm_irecv(c, me - 1, 1, x, row, &r[0]);
        if (me < p - 1) comm_irecv(c, me + 1, 2, x + (m + 1) * n, row, &r[1]);
        if (me > 0) comm_send(c, me - 1, 2, x + n, row);
        if (me < p - 1) comm_send(c, me + 1, 1, x + m * n, row);
