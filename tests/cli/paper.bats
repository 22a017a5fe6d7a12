#!/usr/bin/env bats
# paper.bats - the report of the paper, figures against golden values.

load helper
load planted

# golden FIGURE COLUMNS REST: what the figure's CSV holds, against tests/golden/FIGURE.csv. With GOLDEN set in the
# environment the golden values are written instead; say in the commit why they changed.
golden() {
    works mimdsim paper "$1" --quiet
    [ -s "figures/$1.png" ] && [ -s "figures/$1.svg" ]
    sqlite3 -csv -header :memory: ".import --csv figures/$1.csv t" "SELECT $2 FROM t $3" >"$1.csv"
    if [ -n "${GOLDEN-}" ]; then cp "$1.csv" "$MIMDSIM_SRCDIR/tests/golden/"; fi
    diff "$MIMDSIM_SRCDIR/tests/golden/$1.csv" "$1.csv"
}

@test "machines side by side are two at least" {
    template
    plant "n = 2, P = 2" "$(fastest 100) rnea+aba=1000000"
    plant "n = 16, P = 16" "$(fastest 200) rnea+aba=2000000"
    fails_with 66 mimdsim plot planted.db fig6-machines
    plant "machine = 'paragon', n = 4, P = 4" "$(fastest 100) rnea+aba=1000000"
    works mimdsim plot planted.db fig6-machines
    sql_is planted.db "SELECT count(DISTINCT machine) FROM run" 2
}

@test "figure 5 equals its golden values, and is not run twice" {
    golden fig5 'P, name, round(compute_us, 2) AS compute_us, round(send_us, 2) AS send_us, round(total_us, 2) AS total_us'
    sql_is paper.db "SELECT count(*) FROM run WHERE status = 'ok'" 4
    works mimdsim paper fig5 --quiet
    sql_is paper.db 'SELECT count(*) FROM run' 4
}

@test "figures 6 and 9 equal their golden values" {
    golden fig6 'baseline, P, round(speedup, 3) AS S, round(parallel_fraction, 3) AS f' 'WHERE P IN (2, 16, 45, 128)'
    golden fig9 'panel, bodies_per_processor, P, round(speedup, 3) AS S, round(parallel_fraction, 3) AS f' 'WHERE P IN (2, 16, 128)'
}

@test "figures 7 and 8 equal their golden values" {
    golden fig7 'size, method, P, round(over_serial, 3) AS over_serial, round(over_conventional, 3) AS over_conventional' \
        'WHERE P IN (16, 256)'
    golden fig8 'rank, kind, count(*) AS spans, round(sum(end_us - begin_us), 2) AS us' 'GROUP BY 1, 2 ORDER BY 1, 2'
}

@test "the timeline of a run as text, picture and traces" {
    works mimdsim timeline fig8 --dir tl --quiet
    stdout_says 'rank'
    [ -s tl/timeline.png ] && [ -s tl/timeline.paje ]
    [ "$(sqlite3 :memory: "SELECT json_valid(readfile('tl/timeline.json'))")" = 1 ]
    if command -v pj_dump >/dev/null; then pj_dump tl/timeline.paje >/dev/null; fi
    fails_with 66 mimdsim timeline no-such-scenario
}
