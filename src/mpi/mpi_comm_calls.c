/* mpi_comm_calls.c - the functions that make communicators and tell of them. */
#include <stdio.h>

#include "mpi/mpi_internal.h"

/* --- queries --- */

/* Of an intercommunicator, here and in the next, the own side (section 7.6.1). */
int mpi_comm_size(struct mpi_rank *self, MPI_Comm comm, int *size)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    *size = c->size;
    return MPI_SUCCESS;
}

int mpi_comm_rank(struct mpi_rank *self, MPI_Comm comm, int *rank)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    *rank = c->rank;
    return MPI_SUCCESS;
}

int mpi_comm_test_inter(struct mpi_rank *self, MPI_Comm comm, int *flag)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    *flag = c->remote != NULL;
    return MPI_SUCCESS;
}

int mpi_comm_group(struct mpi_rank *self, MPI_Comm comm, MPI_Group *group)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    *group = mpi_group_handle(c->group);
    return MPI_SUCCESS;
}

/* Section 7.4.1: identical handles, then the same ranks in the same order (congruent), in
 * another order (similar), or other ranks. An intercommunicator is as equal as its less
 * equal side. */
int mpi_comm_compare(struct mpi_rank *self, MPI_Comm comm1, MPI_Comm comm2, int *result)
{
    struct mpi_comm *a = mpi_comm_of(self, comm1), *b = a ? mpi_comm_of(self, comm2) : NULL;
    if (!b) return self->code;
    *result = MPI_IDENT;
    if (a == b) return MPI_SUCCESS;
    *result = !a->remote == !b->remote ? mpi_groups_compare(self, a->group, b->group) : MPI_UNEQUAL;
    if (a->remote && b->remote && *result != MPI_UNEQUAL) {
        int far = mpi_groups_compare(self, a->remote, b->remote);
        if (far != MPI_IDENT) *result = far;
    }
    if (*result == MPI_IDENT) *result = MPI_CONGRUENT;
    return MPI_SUCCESS;
}

/* No program starts others here (chapter 11), so none has a parent. */
int mpi_comm_get_parent(struct mpi_rank *self, MPI_Comm *parent)
{
    (void)self;
    *parent = MPI_COMM_NULL;
    return MPI_SUCCESS;
}

/* --- names --- */

int mpi_comm_get_name(struct mpi_rank *self, MPI_Comm comm, char *comm_name, int *resultlen)
{
    struct mpi_comm *c = comm == MPI_COMM_NULL ? NULL : mpi_comm_of(self, comm);
    /* Section 7.8: the three that the standard provides have names from the start, and
     * the program may give others. A new communicator's name is empty, also a
     * duplicate's. */
    const char *name = "MPI_COMM_NULL";
    if (!c && comm != MPI_COMM_NULL) return self->code;
    if (c) name = c->name ? c->name : "";
    if (c && !c->name && c == self->world_comm) name = "MPI_COMM_WORLD";
    if (c && !c->name && c == self->self_comm) name = "MPI_COMM_SELF";
    return mpi_text_out(comm_name, MPI_MAX_OBJECT_NAME, name, resultlen);
}

/* The text is copied: the program may use its memory again. */
int mpi_comm_set_name(struct mpi_rank *self, MPI_Comm comm, const char *comm_name)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    mpi_give(self->world, c->name);
    c->name = mpi_take_text(self->world, comm_name);
    return MPI_SUCCESS;
}

/* Hints are taken and forgotten, as the standard allows. */
int mpi_comm_set_info(struct mpi_rank *self, MPI_Comm comm, MPI_Info info)
{
    (void)info;
    return mpi_comm_of(self, comm) ? MPI_SUCCESS : self->code;
}

/* The program frees what it gets, so each call makes one, without keys. */
int mpi_comm_get_info(struct mpi_rank *self, MPI_Comm comm, MPI_Info *info_used)
{
    return mpi_comm_of(self, comm) ? mpi_info_create(self, info_used) : self->code;
}

/* --- making --- */

/* dup: with the context that its ranks have agreed on, for as long as it takes. */
static int dup(struct mpi_rank *r, struct mpi_comm *c, int context, MPI_Comm *newcomm)
{
    /* Ranks, topology and attributes go over, messages under way do not: the context is
     * new. A refusal by a copy function undoes it all (section 7.7.2), on this rank
     * alone. */
    c->group->o.uses++;
    struct mpi_comm *made = mpi_comm_make(r, c->group, context, c);
    mpi_topology_copy(r, c, made);
    int code = mpi_attributes_copy(r, KIND_COMM, c, made);
    *newcomm = code == MPI_SUCCESS ? mpi_handle(made) : MPI_COMM_NULL;
    if (code == MPI_SUCCESS) return code;
    mpi_attributes_end(r, KIND_COMM, made);
    mpi_comm_drop(r, made);
    return code;
}

/* Agreeing on the context is a broadcast over the old communicator: duplicating costs
 * simulated time, as it does on a machine. */
int mpi_comm_dup(struct mpi_rank *self, MPI_Comm comm, MPI_Comm *newcomm)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    if (c->remote) return mpi_intercomm_dup(self, c, newcomm);
    return dup(self, c, mpi_context_agree(self, &c->channel, c->sequence++), newcomm);
}

int mpi_comm_dup_with_info(struct mpi_rank *self, MPI_Comm comm, MPI_Info info, MPI_Comm *newcomm)
{
    (void)info;
    return mpi_comm_dup(self, comm, newcomm);
}

/* What a non-blocking duplication needs while it goes on. */
struct idup {
    struct mpi_comm *from;
    MPI_Comm *to;
    unsigned sequence;
};

/* The handle is written when the operation is over; until then the program must not look
 * at it (section 7.4.2). */
static void run_idup(struct mpi_rank *r, void *argument)
{
    const struct idup *x = argument;
    int code = dup(r, x->from, mpi_context_agree(r, &x->from->channel, x->sequence), x->to);
    r->running->code = code;
}

/* The two sides of an intercommunicator meet at once, which is no error: a call may synchronize. */
int mpi_comm_idup(struct mpi_rank *self, MPI_Comm comm, MPI_Comm *newcomm, MPI_Request *request)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    if (c->remote) {
        int code = mpi_intercomm_dup(self, c, newcomm);
        if (code == MPI_SUCCESS) *request = mpi_request_nothing(self);
        return code;
    }
    const struct idup x = {c, newcomm, c->sequence++};
    return mpi_request_task(self, c, run_idup, &x, sizeof x, -1,
                            (struct mpi_start){MPI_NON_BLOCKING, request});
}

int mpi_comm_idup_with_info(struct mpi_rank *self, MPI_Comm comm, MPI_Info info, MPI_Comm *newcomm,
                            MPI_Request *request)
{
    (void)info;
    return mpi_comm_idup(self, comm, newcomm, request);
}

/* A group's rank that does not take part gets nothing; all of the old communicator agree on the
 * context. */
int mpi_comm_create(struct mpi_rank *self, MPI_Comm comm, MPI_Group group, MPI_Comm *newcomm)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_group *g = c ? mpi_group_of(self, group) : NULL;
    if (!g) return self->code;
    /* A context is agreed on by all before anybody leaves, so a wrong group is found
     * first. Ranks may pass disjoint groups: all get the same context, and as they have
     * no rank in common, no message can be taken for another. */
    for (int i = 0; i < g->size; i++)
        if (mpi_group_find(self, c->group, mpi_group_world(g, i)) == MPI_UNDEFINED)
            return mpi_error(self, c, MPI_ERR_GROUP,
                             "rank %d of the group is not in the communicator", i);
    if (c->remote) return mpi_intercomm_part(self, c, g, newcomm);
    int context = mpi_context_agree(self, &c->channel, c->sequence++);
    *newcomm = MPI_COMM_NULL;
    if (g->rank == MPI_UNDEFINED) return MPI_SUCCESS;
    g->o.uses++;
    *newcomm = mpi_handle(mpi_comm_make(self, g, context, c));
    return MPI_SUCCESS;
}

/* Only the group's ranks call this, so they agree among themselves, in a plane of tags
 * for making; the program's tag keeps calls apart that overlap (section 7.4.2). It is cut
 * to the 25 bits that the plane has room for. */
int mpi_comm_create_group(struct mpi_rank *self, MPI_Comm comm, MPI_Group group, int tag,
                          MPI_Comm *newcomm)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_group *g = c ? mpi_group_of(self, group) : NULL;
    struct mpi_channel k;
    if (!g) return self->code;
    *newcomm = MPI_COMM_NULL;
    if (g->rank == MPI_UNDEFINED) return MPI_SUCCESS;
    mpi_channel_make(&k, self, g, c->context, PLANE_MAKING);
    k.base += (int64_t)(tag & 0x1ffffff) * COLLECTIVE_TAGS;
    int context = mpi_context_agree(self, &k, 0);
    g->o.uses++;
    *newcomm = mpi_handle(mpi_comm_make(self, g, context, c));
    return MPI_SUCCESS;
}

/* MPI_UNDEFINED is a color, too: such ranks take part and get MPI_COMM_NULL. */
int mpi_comm_split(struct mpi_rank *self, MPI_Comm comm, int color, int key, MPI_Comm *newcomm)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    if (color < 0 && color != MPI_UNDEFINED)
        return mpi_error(self, c, MPI_ERR_ARG, "color %d is negative", color);
    if (c->remote) return mpi_intercomm_split(self, c, color, key, newcomm);
    struct mpi_comm *made = mpi_comm_split_of(self, c, color, key);
    *newcomm = made ? mpi_handle(made) : MPI_COMM_NULL;
    return MPI_SUCCESS;
}

/* Ranks on one node share memory; of the other kinds there are none. */
int mpi_comm_split_type(struct mpi_rank *self, MPI_Comm comm, int split_type, int key,
                        MPI_Info info, MPI_Comm *newcomm)
{
    (void)info;
    /* MPI_COMM_TYPE_SHARED follows the placement of ranks on nodes. The other types
     * (section 7.4.2) would need a description of what is inside a node. */
    const int *node = self->world->setup->node;
    int color = MPI_UNDEFINED;
    if (split_type == MPI_COMM_TYPE_SHARED) color = node ? node[self->rank] : self->rank;
    else if (split_type != MPI_UNDEFINED &&
             (split_type < MPI_COMM_TYPE_HW_UNGUIDED || split_type > MPI_COMM_TYPE_RESOURCE_GUIDED))
        return mpi_error(self, NULL, MPI_ERR_ARG, "split type %d", split_type);
    return mpi_comm_split(self, comm, color, key, newcomm);
}

/* Attributes go first, while the handle is good: their functions get it (section 7.7.2).
 * Requests under way keep the rest alive. */
int mpi_comm_free(struct mpi_rank *self, MPI_Comm *comm)
{
    struct mpi_comm *c = mpi_comm_of(self, *comm);
    if (!c) return self->code;
    if (c == self->world_comm || c == self->self_comm)
        return mpi_error(self, c, MPI_ERR_COMM, "MPI_COMM_WORLD and MPI_COMM_SELF cannot be freed");
    int code = mpi_attributes_end(self, KIND_COMM, c);
    if (code != MPI_SUCCESS) return code;
    if (c->o.uses > 1) mpi_handle_end(self, c);
    mpi_comm_drop(self, c);
    *comm = MPI_COMM_NULL;
    return MPI_SUCCESS;
}

/* It should wait for what is under way; as no process may leave the run, freeing does. */
int mpi_comm_disconnect(struct mpi_rank *self, MPI_Comm *comm) { return mpi_comm_free(self, comm); }
