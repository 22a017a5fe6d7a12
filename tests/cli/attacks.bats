#!/usr/bin/env bats
# attacks.bats - files of strangers that once broke the program: each gets one message with its place, and nothing else.

load helper

attacks=$MIMDSIM_SRCDIR/tests/data/attacks

@test "a mapping within a list is refused with its line, wherever a list may stand" {
    for verb in check explain run; do
        fails_with 65 mimdsim $verb "$attacks/sweep-null.yaml"
        stderr_says "sweep-null.yaml:6: machine.topology.dims: a mapping '{a: ...}' where a value is expected"
        fails_with 65 mimdsim $verb "$attacks/sweep-null2.yaml"
        stderr_says "sweep-null2.yaml:6: model.gravity: a mapping '{a: ...}' where a value is expected"
    done
    fails_with 65 mimdsim run speedup-t3e --set 'machine.topology.dims=[[a: 1]]'
    stderr_says "machine.topology.dims: a mapping '{a: ...}' where a value is expected"
    for key in machine.topology.links machine.placement.list model.gravity ranks n machine level kernel; do
        fails_with 65 mimdsim run speedup-t3e --set "$key=[[{a: 1}]]"
        fails_with 65 mimdsim run speedup-t3e --set "$key=[{a: [{b: 1}]}]"
    done
    nothing_left_behind
}

@test "a vector file whose counts multiply beyond an int is refused with key, numbers and bytes" {
    awk 'BEGIN {
        n = 7724
        printf "{\"format\": \"dynref-1\", \"name\": \"x\", \"group\": \"x\", \"gravity\": [0, 0, 0], \"nq\": %d, \"nv\": %d,\n\"bodies\": [", 7*n, 6*n
        for (i = 0; i < n; i++)
            printf "%s{\"parent\": %d, \"joint\": {\"type\": \"floating\"}, \"placement\": {\"p\": [0, 0, 0], \"quat\": [0, 0, 0, 1], \"R\": [1, 0, 0, 0, 1, 0, 0, 0, 1]}, \"mass\": 1, \"com\": [0, 0, 0], \"inertia_com\": [1, 0, 0, 1, 0, 1]}", i ? "," : "", i - 1
        printf "],\n\"q\": ["
        for (i = 0; i < n; i++) printf "%s0,0,0,0,0,0,1", i ? "," : ""
        printf "],\n\"qd\": ["
        for (i = 0; i < 6*n; i++) printf "%s0", i ? "," : ""
        printf "],\n\"M\": ["
        for (i = 0; i < 100000; i++) printf "%s1.5", i ? "," : ""
        print "]}"
    }' >large.json
    fails_with 65 mimdsim verify large.json
    stderr_says "large.json:5: 'M' has 100000 of the 2147766336 numbers expected (17.2 GB of them)"
}

@test "a machine whose numbers multiply beyond an int is no machine" {
    for verb in check machines; do
        fails_with 78 mimdsim $verb "$attacks/dragonfly-overflow.yaml"
        stderr_says 'gives more than 16777216 processors'
    done
    fails_with 78 mimdsim run speedup-t3e --set machine.topology.dims='[16777216, 65536, 16777216]'
    stderr_says 'gives more than 16777216 processors'
    fails_with 78 mimdsim run speedup-t3e --set machine.topology.family=fat-tree --set machine.topology.dims='[16777216, 16777216]'
    stderr_says 'gives more than 16777216 processors'
}

@test "a run that outlasts simulated time fails, with the rank and the time it had reached" {
    slow() { mimdsim run speedup-t3e --set machine.node.flop_rate='1 flop/s' --set kernel.steps=300 -o slow.db --quiet "$@"; }
    fails_with 1 slow --set n=64
    stderr_says 'simulated time ends at 1.15e+06 s: rank '
    stderr_says ' had reached 1.15'
    # the parallel run ends in time, the serial codes do not: there is no speedup to tell
    fails_with 1 slow --set n=4
    stderr_says "the parallel run took 858830 s, and 'parallel code on one processor' on one processor takes longer"
    for level in loggp link packet flit auto; do
        fails_with 1 mimdsim run speedup-t3e -o slow.db --quiet --set n=8 --set level=$level --set machine.network.link.bandwidth='1e-6 B/s'
        stderr_says 'simulated time ends at 1.15e+06 s'
    done
    sql_is slow.db "SELECT group_concat(DISTINCT status), max(makespan_ps) FROM run" 'failed|0'
    sql_is slow.db "SELECT count(*) FROM v_speedup" 0
    sql_is slow.db "SELECT (SELECT count(*) FROM baseline) + (SELECT count(*) FROM stage)" 0
    # as long as it fits, time is exact: a flop takes a million times as long
    works mimdsim run speedup-t3e --set n=1 --set ranks=1 --set level=loggp --set machine.node.flop_rate='1 flop/s' -o one.db --quiet
    sql_is one.db "SELECT status, makespan_ps > 1000000000000 FROM run" 'ok|1'
    fails_with 78 mimdsim run speedup-t3e --set machine.network.hop_latency='1 s' --set machine.topology.dims='[16777216]' -o slow.db
    stderr_says 'network.hop_latency: a route of 8388609 routers takes longer than the largest simulated time'
}

# --- texts of a database and gnuplot ----------------------------------------------------------------------------------

# speedup is that of programs of one's own, which need a compiler.
figures() {
    (cd "$MIMDSIM_DATA/plots" && for f in *.gp; do
        case $f in style.gp | _*) ;; speedup.gp) ! command -v gcc >/dev/null || echo speedup ;; *) echo "${f%.gp}" ;; esac
    done)
}

# every_figure: all.db, a database with rows for every figure.
every_figure() {
    if [ -e "$BATS_FILE_TMPDIR/all.db" ]; then cp "$BATS_FILE_TMPDIR/all.db" .; return; fi
    printf '%s\n' 'schema_version: 1' 'question: Small?' 'machine: t3e-300' \
        'model: {generator: serial-chain}' 'kernel: dynamics' 'ranks: n' 'n: 4' >small.yaml
    for scenario in fig5 fig6 fig8 bisection pingpong-machines; do works mimdsim run $scenario -o all.db --quiet; done
    works mimdsim run fig7 --set n=16 -o all.db --quiet
    works mimdsim run fig9 --set ranks=1,2,4,8 -o all.db --quiet
    works mimdsim run fig9-machines --set ranks=1,2,4,8 -o all.db --quiet
    works mimdsim run fig6-machines --set n=2,4,8 -o all.db --quiet
    if command -v gcc >/dev/null; then
        works env XDG_CACHE_HOME="$BATS_TEST_TMPDIR" "$MIMDSIM" run "$MIMDSIM_SRCDIR/examples/prefix-sum.yaml" --set n=100 \
            --set ranks=1,2 -o all.db --quiet
    fi
    works mimdsim why small.yaml -o all.db --quiet
    works mimdsim run small.yaml --uncertainty 8 -o all.db --quiet
    works mimdsim accuracy small.yaml -o all.db --quiet
    works mimdsim stability small.yaml -o all.db --quiet
    works mimdsim explain small.yaml --measure -o all.db --quiet
    works mimdsim load t3e-300 --level packet --rates 0.02,0.05 --no-saturation --messages 10000 -o all.db --quiet
    works mimdsim interference neighbours -o all.db --dir neighbours --quiet
    run mimdsim validate paragon -o all.db --quiet
    run mimdsim claims all.db
    # a plane of two parameters, by hand: to simulate one takes long
    sqlite3 all.db "INSERT INTO explain_point VALUES (1, 'C1', 'key', 'structured', '', 0, 1, 'runs');
        INSERT INTO explain_judged VALUES (1, 'C1', 'variant', 1.0, 0.5, 1);
        INSERT INTO explain_map WITH k(v) AS (VALUES (0), (1))
            SELECT 'C1', a.v, b.v, 'node.call', 'node.flop_rate', 'node.call (50 ns)', 'node.flop_rate (45 Mflop/s)', 0.5 + a.v,
                   0.5 + b.v, 0.5, 1.5, NULL, NULL, 1, 1, 1.2, 1.3, 'variant', 1 FROM k a, k b;
        INSERT INTO explain_answer VALUES ('C1', 'own', 'holds', 'variant', 'structured', '', 0.5, 1, 0.5, 4, 1, 1, 'A sentence.')"
    cp all.db "$BATS_FILE_TMPDIR/"
}

# text_columns: TABLE.COLUMN of every text column of every table that may hold any text.
text_columns() {
    sql all.db "SELECT m.name || '.' || c.name FROM sqlite_schema m, pragma_table_info(m.name) c
                WHERE m.type = 'table' AND c.type = 'TEXT' AND m.sql NOT LIKE '%CHECK (' || c.name || ' IN (%' ORDER BY 1"
}

# word_columns: of those that may hold certain words alone.
word_columns() {
    sql all.db "SELECT m.name || '.' || c.name FROM sqlite_schema m, pragma_table_info(m.name) c
                WHERE m.type = 'table' AND c.type = 'TEXT' AND m.sql LIKE '%CHECK (' || c.name || ' IN (%' ORDER BY 1"
}

# add_to FILE COLUMNS: each text of COLUMNS gets what FILE holds at its end. A column under a CHECK takes it all the same.
add_to() {
    local column where
    cp all.db bad.db
    {
        echo 'PRAGMA ignore_check_constraints = ON; PRAGMA foreign_keys = OFF; BEGIN;'
        for column in $2; do
            # one stage has to keep its name for figure 7
            if [ "$column" = stage.name ]; then where="WHERE name <> 'CFA[2]'"; else where=; fi
            echo "UPDATE ${column%.*} SET ${column#*.} = ${column#*.} || CAST(readfile('$1') AS TEXT) $where;"
        done
        echo 'COMMIT;'
    } | sqlite3 bad.db
}

# svg_alone: the PNG of a figure comes from the same commands; where many figures are drawn their SVG tells as much.
svg_alone() { export MIMDSIM_GNUPLOT=$MIMDSIM_SRCDIR/tests/support/gnuplot-svg.sh; }

# draw_all STATUS...: every figure of bad.db ends with one of STATUS; no command of a text has run, no picture is active.
draw_all() {
    local figure
    rm -rf drawn
    if [ "$*" = 0 ]; then
        # shellcheck disable=SC2046 # one word a figure; the first that fails ends it, and is told
        works mimdsim plot bad.db $(figures) --dir drawn
    else for figure in $(figures); do
        run --separate-stderr -- mimdsim plot bad.db "$figure" --dir drawn
        case " $* " in *" $status "*) ;; *) echo "$figure"; show; return 1 ;; esac
    done; fi
    [ -z "$(find "$BATS_TEST_TMPDIR" -name 'PWNED?')" ] || { echo 'a text was run as a command'; return 1; }
    ! grep -rqi '<script' --include='*.svg' . || { echo 'a text became a part of a picture'; return 1; }
}

@test "no text of a database is a command of gnuplot, whatever it holds" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    every_figure
    # What is left of a figure when these are changed is told by the next test.
    chosen='run.kernel run.status run.base run.placement run.solver run.part_solver run.formulation run.operators run.level run.scenario run.machine run.topology run.precision link_loads.entries
            baseline.name stage.name check_point.suite check_point.quantity check_point.unit check_point.verdict
            setting.key span.kind claim.verdict claim.variant claim.id ladder.ladder ladder.quantity ladder.method ladder.rung
            ladder.status ladder.at ladder.scenario ladder_choice.ladder stability.precision stability.algorithm
            stability.status omission.class run_omission.class setting.value run.config_text
            explain_map.subject explain_answer.subject explain_judged.claim uncertainty.quantity uncertainty_share.quantity'
    shown=
    for column in $(text_columns); do case " $(echo $chosen) " in *" $column "*) ;; *) shown="$shown $column" ;; esac; done
    shown="$shown run.machine stage.name claim.id claim.statement ladder.method stability.algorithm"
    [ "$(echo $shown | wc -w)" -gt 30 ]
    cp all.db bad.db
    draw_all 0
    pictures=$(find drawn -name '*.svg' | wc -l)
    # Quotes and substitutions behind each other: each pair of quotes is whole within the other kind, so that a way out of
    # either is taken. gnuplot itself has no sanitizers: for them control characters and formats are enough.
    texts='quotes lines'
    if sanitized; then texts=lines; fi
    for k in $texts; do
        {
        case $k in
        quotes)
            printf '"; system("touch PWNED1"); set label 98 "<script>'
            printf "'; system('touch PWNED2'); set label 98 '; ! touch PWNED2"
            printf '`touch PWNED3` $(touch PWNED3) ${PWD} @figure @PWNED |touch PWNED3 < touch PWNED3 > PWNED3' ;;
        lines)
            printf '\n system("touch PWNED4")\n! touch PWNED4\r\n"; system("touch PWNED4")\n\t\001\033[2J'
            printf '{/Symbol %%s%%n%%d%%*d%%%%\\\\101\\" {}}{{@_^~&{\\\\\n# %% "" \x27\x27 \\' ;;
        esac
        } >text
        add_to text "$shown"
        draw_all 0
        [ "$(find drawn -name '*.svg' | wc -l)" -eq "$pictures" ]
        svg_alone # the first text has been drawn both ways
    done
}

@test "a text that chooses rows is no command of gnuplot either" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    every_figure
    svg_alone
    printf '"; system("touch PWNED1"); `touch PWNED2` $(touch PWNED3) \x27; system("touch PWNED4") #\x27 @x {/x} %%s%%n\\ |touch PWNED5 <x>\nsystem("touch PWNED6")' >text
    columns='run.kernel run.topology run.level run.formulation run.solver baseline.name setting.value check_point.quantity
             claim.variant build.version'
    if sanitized; then columns='setting.value'; fi
    for column in $columns; do
        add_to text "$column"
        draw_all 0 65 66
    done
    # all at once: most figures find none of their rows
    add_to text "$(text_columns)"
    draw_all 0 65 66 69
    works mimdsim report bad.db --dir drawn
    # a database whose words are none of ours is not read at all
    for column in $(word_columns); do
        add_to text "$column"
        [ "$(sql bad.db "SELECT count(*) FROM ${column%.*}")" -gt 0 ] || continue
        fails_with 65 mimdsim report bad.db --dir drawn
        stderr_says 'CHECK constraint failed in'
    done
    [ -z "$(find "$BATS_TEST_TMPDIR" -name 'PWNED?')" ]
}

@test "the name that a database gives a drawing leads nowhere else" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    every_figure
    svg_alone
    for name in '/../../gone' '../x' '|touch PWNED1' '<touch PWNED2' '`touch PWNED3`' '-e system("touch PWNED4")' "a'b"; do
        # a name takes one way through the program, whatever it asks the shell for
        if sanitized; then case $name in [.\<-]* | \`*) continue ;; esac; fi
        cp all.db bad.db
        sqlite3 bad.db "UPDATE omission SET scenario = '${name//\'/\'\'}'; UPDATE ladder SET scenario = '${name//\'/\'\'}'"
        rm -rf drawn
        works mimdsim plot bad.db omissions accuracy --dir drawn
        # omissions, and three ladders
        [ "$(find drawn -name '*.svg' -size +0 | wc -l)" -eq 4 ]
        [ -z "$(find "$BATS_TEST_TMPDIR" -name 'PWNED?' -o -name 'gone*' -o -path './x*')" ]
    done
    # names that a path cannot tell apart stay two drawings
    cp all.db bad.db
    sqlite3 bad.db "UPDATE omission SET scenario = iif(ordinal % 2, 'a/b', 'a|b')"
    rm -rf drawn
    works mimdsim plot bad.db omissions --dir drawn
    [ "$(find drawn -name '*.svg' | wc -l)" -eq 2 ]
}

@test "a text of a database becomes no markup of a picture or a page" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    every_figure
    printf '%s' "</text><script>alert(1)</script><img src=x onerror=alert(2)>'\"&lt;" >text
    add_to text "run.label run.machine omission.what ladder.method stability.subject claim.statement critical_path.stage"
    run --separate-stderr -- mimdsim report bad.db --dir drawn
    ! grep -lE '<(script|img|foreignObject)|onmouse|onerror=.?alert.2.>' drawn/*.svg
    # the page has one script, its own, and says so to the browser
    [ "$(grep -o '<script' bad.html | wc -l)" -eq 1 ]
    grep -q '<script>// report.js' bad.html
    ! grep -q '<img' bad.html
    grep -q "Content-Security-Policy.*default-src 'none'.*script-src 'sha256-" bad.html
    # where the text is drawn, it is drawn as it is
    grep -q '&lt;script&gt;alert(1)&lt;/script&gt;' bad.html
}

@test "no script of a figure evaluates, includes or starts anything" {
    for script in "$MIMDSIM_DATA"/plots/*.gp; do
        # commands that make commands of text, in any of gnuplot's abbreviations, where a command may begin
        if grep -nE '(^|[;{])[[:space:]]*(ev[a-z]*|sys[a-z]*|lo?a?d?|cal?l?|she?l?l?|python|!)([[:space:](]|$)' "$script"; then return 1; fi
        if grep -nE 'system *\(|[`]|(^|[^"a-zA-Z_^])@[A-Za-z]|set macros|["'\''][<|]' "$script"; then return 1; fi
    done
}

@test "a few lines that ask for a million runs are refused before they take memory or time" {
    seq -s ', ' 0 999 >thousand
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'kernel: dynamics' 'ranks: 1' 'n: 4' \
        "seed: [$(cat thousand)]" "model.seed: [$(cat thousand)]" >million.yaml
    # sanitizers reserve more address space than that
    memory=300000
    (ulimit -v $memory; mimdsim --version) >/dev/null 2>&1 || memory=unlimited
    for verb in check explain run plan; do
        (ulimit -v $memory; mimdsim $verb million.yaml) >out 2>err && status=0 || status=$?
        [ "$status" -eq 78 ]
        grep -q 'the sweep has 1000000 runs; expected at most 100000' err
    done
    [ ! -e mimdsim.db ]
}
