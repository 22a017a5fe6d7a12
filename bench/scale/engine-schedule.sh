#!/bin/sh
# engine-schedule.sh - what one run of mimdsim does that is spread over hosts, as a schedule (docs/scale.md): inverse
# dynamics by recursive doubling, n bodies on n virtual processors, in equal blocks.
#
#     engine-schedule.sh HOSTS N [MESSAGE_NS [CHECK_NS [BAGS]]] >engine.goal
#     mimdsim run engine.goal -m infiniband-ndr --set level=loggp
#
# HOSTS and N are powers of two. MESSAGE_NS: host time of a virtual processor in a step, with its arithmetic; a letter to
# another host costs as much again. CHECK_NS: of a body's reference and check, on the first host. BAGS: in how many
# messages the letters of a step travel. The defaults are measured (docs/scale.md).
#
# In a step of stride d, virtual processors send 96 B to the one d to their left and 48 B to the one d to their right, and
# in two later sweeps 48 B either way. A letter has a head of 56 B. At the end the first host gets the accounts of all, 528 B
# a virtual processor, and checks the answer. The last line, a remark, has the number of letters and their bytes.
set -eu
[ $# -ge 2 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 64; }
exec awk -v hosts="$1" -v n="$2" -v message="${3:-284}" -v check="${4:-3050}" -v bags="${5:-4}" '
function fail(text) { print "engine-schedule.sh: " text >"/dev/stderr"; failed = 1; exit 64 }
function whole(x) { return sprintf("%.0f", x - x % 1) } # some awks print large numbers as 1e+09
function power(x) { while (x > 1 && x % 2 == 0) x /= 2; return x == 1 }

# Letters that leave block `me` for the left (sign -1) or the right (+1) by stride d; only numbers from `low` on send.
function letters(me, d, sign, low,    first, last) {
    first = me * b; last = first + b
    if (sign < 0 && low < d) low = d         # the others have nobody at their left
    if (first < low) first = low
    if (sign > 0 && last > n - d) last = n - d
    # short strides leave the block at its edge only
    if (d < b && sign < 0 && last > me * b + d) last = me * b + d
    if (d < b && sign > 0 && first < me * b + b - d) first = me * b + b - d
    return last > first ? last - first : 0
}

# An operation of rank `me` behind the last one that the engine waits for: it does not wait for what it sends.
function add(text, waits) {
    line[me] = line[me] "o" ++count[me] ": " text "\n"
    if (last[me]) line[me] = line[me] "o" count[me] " requires o" last[me] "\n"
    if (waits) last[me] = count[me]
}

# One step of all hosts. Blocks and strides are powers of two, so all letters of a block go to one other.
function step(d, sign, low, bytes,    out, come, away, i) {
    away = sign * (d < b ? 1 : d / b)
    tag++
    for (me = 0; me < hosts; me++) {
        out = letters(me, d, sign, low)
        come = me - away >= 0 && me - away < hosts ? letters(me - away, d, sign, low) : 0
        all += out
        volume += out * (56 + bytes)
        # a letter costs its sender a message, and its receiver what a message of its own would
        for (i = 0; i < bags; i++) {
            add("calc " whole((b + out) * message / bags), 1)
            if (out > 0) add("send " whole(out * (56 + bytes) / bags) "b to " me + away " tag " tag, 0)
        }
        for (i = 0; come > 0 && i < bags; i++)
            add("recv " whole(come * (56 + bytes) / bags) "b from " me - away " tag " tag, 1)
    }
}

BEGIN {
    if (!power(hosts) || !power(n) || hosts > n) fail("expected powers of two, HOSTS at most N")
    b = n / hosts
    tag = 1
    step(1, -1, 1, 96)
    for (d = 1; d < n; d *= 2) { step(d, -1, 2 * d, 96); step(d, 1, 0, 48) }
    for (d = 1; d < n; d *= 2) step(d, 1, 0, 48)
    for (d = 1; d < n; d *= 2) step(d, -1, 0, 48)
    for (me = 1; me < hosts; me++) add("send " whole(b * 528) "b to 0 tag 1", 1)
    me = 0
    for (i = 1; i < hosts; i++) add("recv " whole(b * 528) "b from " i " tag 1", 1)
    add("calc " whole(n * check), 1)
    print "num_ranks " hosts
    for (me = 0; me < hosts; me++) printf "rank %d {\n%s}\n", me, line[me]
    printf "// %.0f letters, %.0f bytes\n", all, volume
}
END { exit failed ? 64 : 0 }'
