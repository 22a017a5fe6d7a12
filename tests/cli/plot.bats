#!/usr/bin/env bats
# plot.bats - any column over any other: what is drawn, what is left out, and what is refused.

load helper

# The runs that the tests draw: 2 machines x 3 sizes, in a database made once for the file.
setup_file() {
    : "${MIMDSIM_SRCDIR:=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)}"
    export MIMDSIM_DATA=${MIMDSIM_DATA:-$MIMDSIM_SRCDIR}
    cd "$BATS_FILE_TMPDIR"
    "${MIMDSIM:-$MIMDSIM_SRCDIR/mimdsim}" run fig6 --set n=8,16,32 --set level=loggp \
        --set machine.network.hop_latency='60 ns,6 us' --set kernel.operators=structured --set kernel.solver=pcr \
        -o runs.db --quiet >/dev/null
}

runs() { cp "$BATS_FILE_TMPDIR/runs.db" runs.db; }

# cell FILE ROW COLUMN-NAME: of a CSV file without quoted commas.
cell() {
    awk -F, -v row="$2" -v name="$3" 'NR == 1 {for (i = 1; i <= NF; i++) {sub(/\r/, "", $i); if ($i == name) c = i}}
        NR == row + 1 {sub(/\r/, "", $c); print $c}' "$1"
}

@test "curves of a result over a size, told apart by machine, with numbers in base units" {
    runs
    works mimdsim plot runs.db --x n --y makespan --by machine
    stderr_says 'drawn: 6 of 6 runs; curves by machine'
    stdout_is figures/makespan-over-n.png
    [ -s figures/makespan-over-n.svg ] && [ -s figures/makespan-over-n.png ]
    [ "$(cell figures/makespan-over-n.csv 1 curve)" = t3e-300 ]
    [ "$(cell figures/makespan-over-n.csv 4 curve)" = 't3e-300‚ hop_latency 6 us' ]
    [ "$(cell figures/makespan-over-n.csv 1 value)" = "$(sql runs.db "SELECT printf('%.15g', makespan_s) FROM v_run WHERE n = 8 AND name = 't3e-300'")" ]
    # every run that is drawn is named in its provenance
    grep -q '6 runs' figures/makespan-over-n.provenance
}

@test "without --by, runs that would fall on one point become curves" {
    runs
    works mimdsim plot runs.db --x n --y speedup
    stderr_says 'curves by machine'
    # a curve that lies on another is told in the legend
    works mimdsim plot runs.db --x n --y n --by machine --as same
    [ "$(cell figures/same.csv 4 curve)" = 't3e-300‚ hop_latency 6 us = t3e-300' ]
}

@test "what --by leaves together is a mean with its range, and is told" {
    runs
    works mimdsim plot runs.db --x n --y makespan --by level
    stderr_says 'points: mean and range of runs that differ in machine'
    [ "$(cell figures/makespan-over-n.csv 1 rows)" = 2 ]
    sqlite3 :memory: "SELECT $(cell figures/makespan-over-n.csv 1 low) < $(cell figures/makespan-over-n.csv 1 value)
        AND $(cell figures/makespan-over-n.csv 1 value) < $(cell figures/makespan-over-n.csv 1 high)" | grep -qx 1
}

@test "repetitions of one run are a mean with its confidence interval" {
    works mimdsim run fig6 --set n=16 --set level=loggp --set kernel.operators=structured --set kernel.solver=pcr \
        --set machine.noise.compute='20 %' --set repetitions=3 -o noise.db --quiet
    works mimdsim plot noise.db --x n --y makespan
    stderr_says 'bands: 95 % confidence of the mean of repetitions'
    # t(0.975, 2) = 4.303; the view v_repetition computes the same interval by itself
    half=$(sql noise.db 'SELECT confidence95_ps * 1e-12 FROM v_repetition')
    value=$(cell figures/makespan-over-n.csv 1 value) high=$(cell figures/makespan-over-n.csv 1 high)
    sqlite3 :memory: "SELECT abs($high - $value - $half) < 1e-9 * $value" | grep -qx 1
}

@test "a heat map of two swept keys; log axes where the range asks for it, or as --log says" {
    runs
    works mimdsim plot runs.db --x n --y hop_latency --z speedup
    [ "$(cell figures/speedup-over-n-hop_latency.csv 1 y)" = 6e-08 ]
    [ "$(cell figures/speedup-over-n-hop_latency.csv 4 y)" = 6e-06 ]
    works mimdsim plot runs.db --x hop_latency --y makespan --by n --quiet
    [ "$(cell figures/makespan-over-hop_latency.about.csv 1 xlog)" = 2 ]
    [ "$(cell figures/makespan-over-hop_latency.about.csv 1 xlabel)" = 'network.hop_latency [µs]' ]
    works mimdsim plot runs.db --x hop_latency --y makespan --by n --log none --quiet
    [ "$(cell figures/makespan-over-hop_latency.about.csv 1 xlog)" = 0 ]
    works mimdsim plot runs.db --x machine --y makespan --where n=16 --as bars
    stderr_says 'left out: 4 by --where'
    grep -q 'figure = .bars' figures/bars.gp
    grep -q 'boxxyerror' figures/bars.gp
}

@test "--where compares numbers with units, words, lists and patterns; figures by name take it, too" {
    runs
    works mimdsim plot runs.db --x n --y makespan --where 'hop_latency<1 us' --quiet
    [ "$(wc -l <figures/makespan-over-n.csv)" = 4 ]
    works mimdsim plot runs.db --x n --y makespan --where 'n=8|32' --where 'machine~*6 us' --quiet
    [ "$(wc -l <figures/makespan-over-n.csv)" = 3 ]
    works mimdsim plot runs.db fig6 --where 'machine=t3e-300, hop_latency 6 us'
    stderr_says 'drawn from 3 of 6 runs'
    grep -q '3 runs' figures/fig6.provenance
    # the database itself is as it was
    sql_is runs.db 'SELECT count(*) FROM run' 6
}

@test "conditions and queries of strangers write nothing" {
    runs
    before=$(sha256sum <runs.db)
    fails_with 66 mimdsim plot runs.db --x n --y makespan --where "kernel=x'; DROP TABLE run; --"
    fails_with 64 mimdsim plot runs.db --x 'n"; DROP TABLE run; --' --y makespan
    fails_with 64 mimdsim plot runs.db --x n --y makespan --by 'n) FROM run; DELETE FROM run; --'
    for evil in 'DELETE FROM run' 'DROP TABLE run' 'SELECT 1; DELETE FROM run' "ATTACH 'x.db' AS x" 'PRAGMA writable_schema = 1' \
        'CREATE TABLE t (a)' "VACUUM INTO 'stolen.db'"; do
        echo "$evil" >evil.sql
        run --separate-stderr -- mimdsim plot runs.db evil.sql
        [ "$status" -ne 0 ] || { echo "ran: $evil"; return 1; }
    done
    [ ! -e stolen.db ] && [ ! -e x.db ]
    [ "$before" = "$(sha256sum <runs.db)" ]
    # a text of the database that looks like gnuplot is a text
    sqlite3 runs.db "UPDATE run SET label = '\`touch pwned\`\".system(\"touch pwned\").\"'"
    works mimdsim plot runs.db --x n --y makespan --by machine,hop_latency
    [ ! -e pwned ] && [ ! -e figures/pwned ]
}

@test "a query of one's own is drawn with the same options" {
    runs
    echo "SELECT n, makespan_s * 1e6 AS micro, name AS machine FROM v_run -- mine" >mine.sql
    works mimdsim plot runs.db mine.sql
    stdout_is figures/mine.png
    [ "$(cell figures/mine.csv 1 curve)" = t3e-300 ]
    works mimdsim plot runs.db mine.sql --x machine --y micro --where n=32 --kind bars --as mine32
    [ "$(wc -l <figures/mine32.csv)" = 3 ]
    fails_with 64 mimdsim plot runs.db mine.sql --y mirco
    stderr_says "'mirco' is no column of the query; did you mean 'micro'?"
    # one that has no end, and one of which a part can be drawn
    many='WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x, x AS y FROM c'
    echo "$many" >endless.sql
    fails_with 64 mimdsim plot runs.db endless.sql
    stderr_says 'more than 1000000 rows are too many for a figure'
    echo "$many LIMIT 60000" >long.sql
    fails_with 64 mimdsim plot runs.db long.sql
    stderr_says '60000 rows are more than a figure can show'
    works mimdsim plot runs.db long.sql --where 'x<9'
}

@test "what cannot be drawn is told, with the nearest name" {
    runs
    fails_with 64 mimdsim plot runs.db --x n --y sppedup
    stderr_says "did you mean 'speedup'?"
    fails_with 64 mimdsim plot runs.db --x n
    stderr_says '--y is missing'
    fails_with 64 mimdsim plot runs.db --x bandwidth --y speedup
    stderr_says "'bandwidth' may be"
    fails_with 64 mimdsim plot runs.db --x n --y machine
    stderr_says "'name' is no number"
    fails_with 66 mimdsim plot runs.db --x n --y speedup --where level=likn
    stderr_says 'its values are: loggp'
    fails_with 64 mimdsim plot runs.db --x n --y speedup --where 'hop_latency<1 MB'
    stderr_says "'MB' is the unit of a size"
    fails_with 64 mimdsim plot runs.db --x n --y speedup --where level
    stderr_says 'expected KEY=VALUE'
    fails_with 64 mimdsim plot runs.db --x n --y speedup --kind line
    stderr_says "did you mean 'lines'?"
    fails_with 64 mimdsim plot runs.db --x n --y speedup --wehre n=8
    stderr_says "did you mean '--where'?"
    fails_with 64 mimdsim plot --x n --y speedup
    stderr_says 'the database is missing'
    fails_with 66 mimdsim plot runs.db missing.sql
    fails_with 66 mimdsim plot runs.db _bars
    stderr_says "there is no figure '_bars'"
    works mimdsim plot runs.db --columns
    stdout_says makespan_s
    stdout_says 'machine.network.hop_latency'
}

@test "every option that a verb takes stands in its list of options" {
    for file in "$MIMDSIM_SRCDIR"/src/app/cmd_*.c "$MIMDSIM_SRCDIR"/src/app/plot_options.c; do
        verb=$(basename "$file" .c) verb=${verb#cmd_}
        [ "$verb" != plot_options ] || verb=plot
        case $verb in cc | mpirun | lists) continue ;; esac
        mimdsim "$verb" --help >help
        for option in $(grep -o 'take_[a-z_]*([^"]*"--[a-z-]*"' "$file" | grep -o -e '--[a-z-]*') \
            $( [ "$verb" != plot ] || echo --x --y --z --by --title --as --where); do
            grep -q -e "^ .* $option" help || { echo "mimdsim $verb --help lacks $option"; return 1; }
        done
    done
}

@test "large powers of two have the prefixes of sizes" {
    runs
    echo 'SELECT column1 AS bytes, column2 AS took_s FROM (VALUES (64, 1e-6), (4096, 2e-6), (262144, 9e-6), (4194304, 1e-4))' >sizes.sql
    works mimdsim plot runs.db sizes.sql
    sed 's/<[^>]*>//g' figures/sizes.svg | tr -d ' ' >texts
    for text in 64 256 1Ki 16Ki 256Ki 4Mi; do grep -qxF "$text" texts || { echo "no $text"; return 1; }; done
    run ! grep '[0-9]ki' texts
}
