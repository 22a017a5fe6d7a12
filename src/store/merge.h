/* merge.h - the runs of one database put into another one: campaigns that several hosts made,
 * joined.
 *
 * A run is identified by (config_hash, seed, rep), so merging the same database again changes
 * nothing. */
#ifndef STORE_MERGE_H
#define STORE_MERGE_H

#include "store/store.h"

/* What store_merge did. */
struct store_merged {
    int64_t added;    /* runs that were not there */
    int64_t replaced; /* runs that had not ended ok, and did in the other database */
    int64_t present;  /* runs that stay as they were */
    /* rows of studies that were not there: checks, ladders, stability, omissions */
    int64_t studies;
};

/* store_merge: put the runs of the database `from`, with all that belongs to them and the build
 * that made each, into `s`, and the rows of studies that are no judgments of all runs together.
 *
 *   s     in   open for writing
 *   from  in   path of a database of this version
 *   done  out  what was done
 *
 * One transaction: all of it or nothing. Returns false with ERR_NO_INPUT, ERR_DATA (no database of
 * ours or an older one; the same run with two digests, which names both builds), ERR_USAGE (`from`
 * is `s` itself), ERR_BUSY or ERR_IO. */
bool store_merge(struct store *s, const char *from, struct store_merged *done, struct err *e);

#endif
