    if (me % 2 == 0) {
        send_synchronously(c, next, &own);
        comm_recv(c, last, 0, &got, 8);
    } else {
        comm_recv(c, last, 0, &got, 8);
        send_synchronously(c, next, &own);
    }
