#!/usr/bin/env bats
# timeline.bats - parts of a run's timeline, its picture at any number of ranks, the critical path over it.

load helper

# csv FILE QUERY: a query on the table t of a CSV file.
csv() { sqlite3 :memory: ".import --csv $1 t" "$2"; }

@test "a part of a run is shown as text and in traces" {
    works mimdsim timeline fig8 --from '1 ms' --to '2 ms' --ranks 1..2 --format text
    stdout_says '1000.000 to 2000.000 us'
    ! printf '%s\n' "$output" | grep -qE '^ +[03]  '
    printf '%s\n' "$output" | grep -qE '^ +2  '
    works mimdsim timeline fig8 --ranks 0 --format csv --dir one --quiet
    [ "$(csv one/timeline.csv 'SELECT group_concat(DISTINCT rank) FROM t')" = 0 ]
    works mimdsim timeline fig8 --from '1 ms' --to '2 ms' --format csv --dir two --quiet
    [ "$(csv two/timeline.csv 'SELECT count(*) > 10, min(end_ps + 0) > 1000000000, max(begin_ps + 0) < 2000000000 FROM t')" = '1|1|1' ]
}

@test "a part that is none is refused, with what the run has" {
    fails_with 64 mimdsim timeline fig8 --from 300
    stderr_says '--from'
    fails_with 64 mimdsim timeline fig8 --from '2 ms' --to '1 ms'
    stderr_says '--to is not after --from'
    fails_with 64 mimdsim timeline fig8 --from '1 s'
    stderr_says '--from: the run ends at 5532.64 us'
    for ranks in 3..1 -1..2 x 1..x '' 1..2..3 1.5; do
        fails_with 64 mimdsim timeline fig8 --ranks "$ranks"
        stderr_says 'is no range of ranks such as 0..15'
    done
    fails_with 64 mimdsim timeline fig8 --ranks 2..4
    stderr_says 'the run has ranks 0 to 3'
}

@test "few ranks are drawn span by span, many in groups, and nothing of their time is lost" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    works mimdsim timeline speedup-t3e --set n=8 --set level=link --format picture --dir few --quiet
    [ -s few/timeline.png ] && [ "$(csv few/timeline.about.csv 'SELECT rows, single FROM t')" = '8|1' ]
    works mimdsim timeline speedup-t3e --set n=128 --set level=link --format picture --dir many --quiet
    [ "$(csv many/timeline.about.csv 'SELECT rows, single FROM t')" = '120|0' ]
    grep -q 'ranks 0 to 127 in 120 rows' many/timeline.svg
    for dir in few many; do
        # at each time the ranks that do something are no more than there are
        n=8; [ $dir = few ] || n=128
        [ "$(csv $dir/timeline.share.csv "SELECT count(*), max(compute + send + recv + wait + barrier) <= $n.001 FROM t")" = '400|1' ]
        # pieces of the path along ranks add up to the run
        csv $dir/timeline.path.csv "SELECT printf('%.3f', sum(to_us - from_us)) FROM t WHERE from_y = to_y" >path
        csv $dir/timeline.about.csv "SELECT printf('%.3f', makespan_us) FROM t" | diff - path
    done
    # bars of one row follow each other
    [ "$(csv many/timeline.csv 'SELECT count(*) FROM t a JOIN t b ON a.y = b.y AND a.begin_us + 0 < b.begin_us + 0 AND a.end_us + 0 > b.begin_us + 1e-6')" = 0 ]
}

@test "the picture of a stored run has its critical path, found by running it again" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    works mimdsim run fig8 -o eight.db --quiet
    works mimdsim timeline eight.db --format picture --dir stored --quiet
    works mimdsim timeline fig8 --format picture --dir now --quiet
    diff stored/timeline.path.csv now/timeline.path.csv
    [ "$(wc -l <now/timeline.path.csv)" -gt 20 ]
    # a run that cannot be made again has a picture without it
    sqlite3 eight.db "UPDATE run SET config_text = 'nonsense'"
    works mimdsim timeline eight.db --format picture --dir without
    stderr_says 'the picture has no critical path: run 1 cannot be made again'
    [ "$(wc -l <without/timeline.path.csv)" -eq 1 ] && [ -s without/timeline.svg ]
}
