/* node_cost.c - rates and cycles of a node as picoseconds per operation. */
#include "machine/node_cost.h"

/* A clock of 0 means that cycle counts cost nothing. */
static double cycles_ps(double cycles, double clock)
{
    return clock > 0 ? cycles / clock * 1e12 : 0;
}

/* Where no machine file says it: one instruction a cycle, or, on processors that issue several, as
 * many as a scalar product needs at the flop rate: five (load, load and multiply, add, advance,
 * branch) for its two flops. */
static double instruction_ps(const struct node_spec *s)
{
    if (s->instruction_cycles > 0) return cycles_ps(s->instruction_cycles, s->clock);
    const double cycle = cycles_ps(1, s->clock),
                 product = s->flop_rate > 0 ? 1e12 / (2.5 * s->flop_rate) : cycle;
    return cycle < product ? cycle : product;
}

/* A byte of the first level that there is: without caches that is the memory. */
static double nearest_ps(const struct node_spec *s)
{
    int i = NODE_L1;
    while (i < NODE_MEMORY && s->level[i].bytes == 0) i++;
    return s->level[i].bandwidth > 0 ? 1e12 / s->level[i].bandwidth : 0;
}

/* How much longer one price is than another; one of 0 is not known, and taken to be equal. */
static double longer_ps(double cycles, double than, double clock)
{
    return cycles > 0 ? cycles_ps(cycles - than, clock) : 0;
}

/* Picoseconds for one operation of each class of base/work.h, as double: a sum is rounded to whole
 * picoseconds once, by node_cost_ps. A rate of 0 means: free. */
struct node_cost node_cost_make(const struct node_spec *s)
{
    return (struct node_cost){
        .flop = s->flop_rate > 0 ? 1e12 / s->flop_rate : 0,
        .div = cycles_ps(s->div_cycles, s->clock),
        .sqrt = cycles_ps(s->sqrt_cycles, s->clock),
        .trig = cycles_ps(s->trig_cycles, s->clock),
        .byte = s->copy_bandwidth > 0 ? 1e12 / s->copy_bandwidth : 0,
        .call = s->call_time * 1e12,
        .instruction = instruction_ps(s),
        .moved = nearest_ps(s),
        .roofline = s->model == NODE_ROOFLINE,
        .issue = cycles_ps(s->code.issue, s->clock),
        .code_div = cycles_ps(s->code.div > 0 ? s->code.div : s->div_cycles, s->clock),
        .code_root = cycles_ps(s->code.root > 0 ? s->code.root : s->sqrt_cycles, s->clock),
        .chain = cycles_ps(s->code.chain, s->clock),
        .step = cycles_ps(s->code.step, s->clock),
        .load = cycles_ps(s->code.load, s->clock),
        .whole = cycles_ps(s->code.whole, s->clock),
        .add = cycles_ps(s->code.add, s->clock),
        .multiply = cycles_ps(s->code.multiply, s->clock),
        .fetch = cycles_ps(s->code.fetch, s->clock),
        .window = s->code.window,
        .late = longer_ps(s->code.add_latency, s->code.chain, s->clock),
        .product =
            longer_ps(s->code.multiply_latency, CODE_PRODUCT_CYCLES * s->code.step, s->clock),
    };
}

/* The longest chain of a round by itself, divided by the rounds on their way. */
double node_cost_window_ps(const struct node_cost *c, const struct code_work *code)
{
    if (!(c->window > 0)) return 0;
    const double round = code->once_flop * c->chain + code->once_cycle * c->step +
                         code->once_late * c->late + code->once_product * c->product;
    return round * code->floating / (code->floating + c->window);
}
