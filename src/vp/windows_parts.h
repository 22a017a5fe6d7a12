/* windows_parts.h - windows of simulated time and what goes between the network and the ranks in
 * them: the insides of windows.h.
 *
 * windows.c: threads and windows; windows_mail.c: turns and messages; windows_ranks.c: shares of
 * ranks in one window; ways.c: for which runs. */
#ifndef VP_WINDOWS_PARTS_H
#define VP_WINDOWS_PARTS_H

#include "vp/team_parts.h"
#include "vp/windows.h"

/* A message, and the turn that it is for or that sent it. */
struct entry {
    struct message *m;
    int turn;
};

/* Entries of one share, by rising turn. */
struct mail {
    struct entry *entry; /* (capacity) owned */
    int n, capacity, at; /* at: the next one to be read */
};

/* Of one window: the messages that came, each for a turn of its receiver's share, and what was sent
 * in these turns. Turns are numbered in the order of one thread. */
struct window {
    struct mail *in, *out; /* (nshare) */
    int *share;            /* (nturn) whose turn it is; owned */
    int nturn, capacity;
    sim_ps first; /* the event of the first that came, SIM_NEVER: none */
};

/* A share's part, in a line of the cache of its own. */
struct side {
    int turn; /* in progress */
    struct mail *out;
    _Atomic int64_t taken; /* the last window that a thread has run it in */
} __attribute__((aligned(64)));

struct windows {
    struct team *team;
    struct world *world;
    struct side *side; /* (nshare) */
    struct window window[3];
    /* what the network fills; of what the ranks go on; what they sent before, for the network */
    struct window *coming, *present, *past;
    sim_ps lookahead;
    sim_ps wire; /* from when a message is ready to its first event, at least */
    sim_ps done; /* the network has no event any more before this */
    /* ranks go on in the order of turns; a barrier is open: ranks that it has let go wait */
    bool in_order, opened;
    int inside; /* ranks in the machine's barrier */
    bool ended;
    /* Threads: number of the window that is theirs, shares that nobody has run in it. */
    _Atomic int64_t number;
    _Atomic int left;
    _Atomic bool over;
};

/* windows_share_of: the number of the share whose world w is. */
static inline int windows_share_of(const struct world *w) { return w->first >> w->team->shift; }

/* windows_receiver: whose turn m is when it arrives: a clear to send is its sender's. */
static inline struct vp *windows_receiver(const struct message *m)
{
    return m->kind == MESSAGE_CLEAR_TO_SEND ? m->from : m->to;
}

/* --- windows_mail.c --- */

/* windows_turn: a new turn of `share` in w, behind all others; returns its number. windows_add: m
 * to the end of b, for turn `turn`. */
int windows_turn(struct window *w, int share);
void windows_add(struct mail *b, struct message *m, int turn);

/* --- windows_ranks.c --- */

/* windows_begin: the ranks of share i are made by worker k and go on for the first time.
 * windows_share: those of share i to which messages have come in the present window. */
void windows_begin(struct windows *s, struct worker *k, int i);
void windows_share(struct windows *s, struct worker *k, int i);

/* windows_in_order: all ranks to which messages have come, in the order of turns, on the caller's
 * thread. windows_first_barrier: all ranks have entered the machine's barrier in their first turn:
 * they go on. */
void windows_in_order(struct windows *s);
void windows_first_barrier(struct windows *s);

#endif
