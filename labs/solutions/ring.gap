        comm_recv(c, me - 1, 0, token, bytes);
        token[0] += 1;
        comm_send(c, (me + 1) % p, 0, token, bytes);
