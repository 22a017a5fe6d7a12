/* publish.h - how the file of a new database comes to its place: whole, under its name at once. */
#ifndef STORE_PUBLISH_H
#define STORE_PUBLISH_H

#include <stdbool.h>
#include <stddef.h>

#include "base/err.h"

/* A file beside its place, locked until it is dropped. */
struct published {
    int file;   /* -1: none was made */
    char *name; /* owned */
    bool late;  /* another program has made the file at its place meanwhile */
};

/* publish_place: write the (size) bytes of `image` (`front`: image_put), NULL: an empty database,
 * beside `path`, flush them, and link the file to `path`, where none is there. So no one ever sees,
 * and no failure leaves, half of one. *b begins as {.file = -1}, and ends with publish_drop in any
 * case. Returns false with ERR_CREATE or ERR_IO. */
bool publish_place(const char *path, const unsigned char *image, size_t size, bool front,
                   struct published *b, struct err *e);

/* publish_drop: remove the file beside the place; what was linked stays. */
void publish_drop(struct published *b);

/* publish_new: the file of an empty database at `path`; when another program was faster, its file
 * is the one. Returns false as publish_place. */
bool publish_new(const char *path, struct err *e);

/* publish_network: whether `path` is on a file system that several hosts share. */
bool publish_network(const char *path);

/* publish_folder: the folder that `path` lies in, with its slash; for the caller to free. */
char *publish_folder(const char *path);

#endif
