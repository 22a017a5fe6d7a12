#!/bin/sh
# engine-schedule.sh - what one run of mimdsim does that is spread over hosts, as a schedule (docs/scale.md): inverse
# dynamics by recursive doubling, n bodies on n virtual processors, in equal blocks.
#
#     engine-schedule.sh HOSTS N [MESSAGE_NS [BODY_NS [SWEEP_NS [BAGS]]]] >engine.goal
#     mimdsim run engine.goal -m infiniband-ndr --set level=loggp
#
# HOSTS and N are powers of two. MESSAGE_NS: host time of a virtual processor in a step, with its arithmetic; a letter to
# another host costs as much again. BODY_NS: of a body that its host makes, and whose answer it checks. SWEEP_NS: of a body
# in each of the two sweeps of the serial reference along the chain, which hosts make one after the other. BAGS: in how
# many messages the letters of a step travel. The defaults are measured (docs/scale.md).
#
# In a step of stride d, virtual processors send 96 B to the one d to their left and 48 B to the one d to their right, and
# in two later sweeps 48 B either way. A letter has a head of 56 B. At the end the digest, 8 B, goes from host to host, as do
# 144 B of a motion and back 48 B of a force, and 640 B of sums go to the first one. The last line, a remark, has the number
# of letters and their bytes.
set -eu
[ $# -ge 2 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 64; }
exec awk -v hosts="$1" -v n="$2" -v message="${3:-273}" -v body="${4:-2280}" -v sweep="${5:-95}" -v bags="${6:-4}" '
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

# What hosts do one after the other, from the first to the last (sign 1) or back, handing `bytes` on.
function along(sign, bytes, ns,    at) {
    tag++
    for (at = 0; at < hosts; at++) {
        me = sign > 0 ? at : hosts - 1 - at
        if (at > 0) add("recv " bytes "b from " me - sign " tag " tag, 1)
        add("calc " whole(b * ns), 1)
        if (at < hosts - 1) add("send " bytes "b to " me + sign " tag " tag, 0)
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
    for (me = 0; me < hosts; me++) add("calc " whole(b * body), 1)
    along(1, 144, sweep)
    along(-1, 48, sweep)
    along(1, 8, 0)
    for (me = 1; me < hosts; me++) add("send 640b to 0 tag " tag + 1, 0)
    me = 0
    for (i = 1; i < hosts; i++) add("recv 640b from " i " tag " tag + 1, 1)
    print "num_ranks " hosts
    for (me = 0; me < hosts; me++) printf "rank %d {\n%s}\n", me, line[me]
    printf "// %.0f letters, %.0f bytes\n", all, volume
}
END { exit failed ? 64 : 0 }'
