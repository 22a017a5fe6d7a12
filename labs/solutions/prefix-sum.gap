        double lower = 0;
        if (me + d < p) comm_send(c, me + d, d, &sum, 8);
        if (me >= d) comm_recv(c, me - d, d, &lower, 8);
        sum += lower;
