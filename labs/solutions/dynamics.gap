        if (me + d < p) comm_send(c, me + d, d, &own, sizeof own);
        if (me - d >= 0) comm_send(c, me - d, d, &own, sizeof own);
        if (me - d >= 0) comm_recv(c, me - d, d, &below, sizeof below);
        if (me + d < p) comm_recv(c, me + d, d, &above, sizeof above);
