#!/usr/bin/env bats
# main_job.bats - the speed-up scenario as it is shipped: the same bits on every compiler, level of optimisation and
# way to switch fibers; every picosecond accounted for; costs foretold.
#
# tests/golden/speedup-t3e.txt holds level|n|messages|makespan_ps|digest. A change of the model or of a kernel changes
# it: look at the difference, then write it anew with the query of the first test.

load helper

@test "the main job gives the golden digests, whatever the build" {
    works mimdsim run "$MIMDSIM_SRCDIR/scenarios/speedup-t3e.yaml" --quiet
    stderr_is_empty
    sql mimdsim.db 'SELECT level, n, messages, makespan_ps, digest FROM run ORDER BY level, n' >found.txt
    diff "$MIMDSIM_SRCDIR/tests/golden/speedup-t3e.txt" found.txt
}

@test "every point is ok, verified twice, and accounted for to the picosecond" {
    works mimdsim run speedup-t3e --quiet
    sql_is mimdsim.db "SELECT count(*), sum(status = 'ok') FROM run" '28|28'
    sql_is mimdsim.db 'SELECT count(*), min(passed), max(relative_error) > 0 FROM error_check' '56|1|1'
    sql_is mimdsim.db 'SELECT count(*), max(abs(difference_ps)), max(accounting_error_ps) FROM v_accounting' '28|0|0'
    sql_is mimdsim.db 'SELECT count(*) FROM run r WHERE messages <> (SELECT sum(messages) FROM stage WHERE run_id = r.id)' 0
}

@test "all levels account for every picosecond, under the names of the paper and what idles at the end" {
    printf '%s\n' 'schema_version: 1' 'question: Accounts?' 'machine: t3e-300' 'model: {generator: serial-chain}' \
        'kernel: dynamics' 'ranks: n' 'sweep: {level: [loggp, link, packet, flit, auto], n: [3, 12]}' >small.yaml
    works mimdsim run small.yaml --quiet
    sql_is mimdsim.db 'SELECT count(*), max(abs(difference_ps)), max(accounting_error_ps), min(makespan_ps) > 0
        FROM v_accounting' '10|0|0|1'
    sql_is mimdsim.db "SELECT group_concat(name, ', ') FROM (SELECT name FROM stage WHERE run_id = 1 ORDER BY stage)" \
        'Pre-processing, NE[1], NE[2], NE[3], CFA[1], CFA[2], CFA[3], end'
}

@test "explain foretells messages, bytes and operations within a fifth" {
    works mimdsim explain speedup-t3e --json
    printf '%s' "$output" >estimate.json
    works mimdsim run speedup-t3e --quiet
    sql_is mimdsim.db "WITH e AS (SELECT key + 1 AS id, value AS v FROM json_each(readfile('estimate.json'), '\$.runs')),
        c AS (SELECT r.id, r.n, r.messages, r.sent_bytes, sum(s.flops) AS flops FROM run r JOIN stage s ON s.run_id = r.id
            GROUP BY r.id)
        SELECT count(*), max(abs(v ->> 'bodies' - n)), max(abs(1.0 * (v ->> 'messages') / messages - 1)) <= 0.2,
            max(abs(1.0 * (v ->> 'bytes') / sent_bytes - 1)) <= 0.2, max(abs(1.0 * (v ->> 'flops') / flops - 1)) <= 0.2
        FROM e JOIN c USING (id)" '28|0|1|1|1'
}

@test "every answer as JSON is one document" {
    works mimdsim run speedup-t3e --set n=4 --quiet
    for command in 'run speedup-t3e' 'explain speedup-t3e' 'machines t3e-300' 'machines --compare t3e-300 paragon' \
        'plot' 'plot mimdsim.db fig5' "check $MIMDSIM_SRCDIR/scenarios/speedup-t3e.yaml" \
        "check $MIMDSIM_SRCDIR/scenarios/speedup-t3e.yaml $MIMDSIM_SRCDIR/machines/t3e-300.yaml"; do
        # shellcheck disable=SC2086
        works mimdsim $command --json --quiet
        json_is_valid
        stderr_is_empty
    done
}

@test "every failure as JSON is one document with kind and status, wrong options among them" {
    while read -r status kind command; do
        # shellcheck disable=SC2086
        fails_with "$status" mimdsim $command --json
        json_is_valid
        json_is '$.error.exit_status' "$status"
        json_is '$.error.kind' "$kind"
        [ -n "$stderr" ] || { echo "nothing on stderr: $command"; return 1; }
    done <<'END'
64 usage rnu
64 usage run
64 usage run speedup-t3e --no-such-option
64 usage run speedup-t3e --jobs 0
64 usage run speedup-t3e another
65 bad-data run speedup-t3e --set n=0
66 no-input run speedup-te3
66 no-input plot none.db fig6
73 cannot-create run speedup-t3e -o nowhere/x.db
78 config run speedup-t3e --set n=500
END
    works mimdsim check "$MIMDSIM_SRCDIR/scenarios/speedup-t3e.yaml"
    fails_with 66 mimdsim check "$MIMDSIM_SRCDIR/scenarios/speedup-t3e.yaml" none.yaml --json
    json_is '$[0].kind' ok
    json_is '$[1].exit_status' 66
    nothing_left_behind
}
