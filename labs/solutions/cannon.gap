        const int left = (column + q - 1) % q, right = (column + 1) % q;
        const int above = (row + q - 1) % q, below = (row + 1) % q;
        comm_send(c, row * q + left, 0, a, bytes);
        comm_recv(c, row * q + right, 0, a, bytes);
        comm_send(c, above * q + column, 1, b, bytes);
        comm_recv(c, below * q + column, 1, b, bytes);
