#!/usr/bin/env bats
# mistakes.bats - what a first-time user gets wrong, command by command: the documented status, the value, what was expected.

load helper

# files: one of each kind to be mistaken for another.
files() {
    printf '%s\n' 'schema_version: 1' 'base: t3e-300' 'title: Mine' >my.yaml
    printf '%s\n' 'schema_version: 1' 'base: t3e-3000' >badbase.yaml
    printf '%s\n' 'schema_version: 1' 'question: q' 'machine: t3e-300' 'model: {generator: urdf, path: x.urdf}' \
        'kernel: dynamics' 'ranks: n' >robot.yaml
    echo 'no robot' >x.urdf
    echo '{"a":' >x.json
    echo 'plain text' >plain.txt
    mkdir folder
    "$MIMDSIM" run speedup-t3e --quiet --set n=4 --set level=loggp -o some.db >/dev/null
}

# mistaken: lines "STATUS # TEXT # COMMAND" on stdin; each ends so, says TEXT in its one message, and leaves no file behind.
mistaken() {
    local state text command before
    while IFS='#' read -r state text command; do
        before=$(ls -A)
        eval "fails_with ${state% } mimdsim $command"
        stderr_says "$(sed 's/^ *//; s/ *$//' <<<"$text")" || { echo "command: $command"; return 1; }
        stdout_is_empty || { echo "command: $command"; return 1; }
        [ "$(ls -A)" = "$before" ] || { echo "left behind by $command:"; ls -A; return 1; }
    done
}

@test "a file of another kind is named for what it is, with the verb that takes it" {
    files
    mistaken <<'END'
64 # my.yaml is a machine, not a scenario: `mimdsim machines my.yaml` shows it # run my.yaml
64 # `mimdsim run SCENARIO --machine t3e-300` uses it # run t3e-300
64 # some.db is a database, not a scenario: `mimdsim plot some.db` # run some.db
64 # x.urdf is a robot, not a scenario # explain x.urdf
64 # x.json is a file of reference cases, not a scenario: `mimdsim verify x.json` # run x.json
64 # speedup-t3e is a scenario, not a machine: `mimdsim run speedup-t3e` runs it # machines speedup-t3e
64 # robot.yaml is a scenario, not a machine # machines robot.yaml
64 # --machine: fig6 is a scenario, not a machine # run speedup-t3e -m fig6
64 # 'fig6' is not a database; the database comes first: `mimdsim plot some.db fig6` # plot fig6 some.db
64 # 'fig6' is a figure; the database comes first: `mimdsim plot mimdsim.db fig6` # plot fig6
64 # the database comes first: `mimdsim query some.db "SELECT 1"` # query 'SELECT 1' some.db
64 # the database comes first: `mimdsim timeline some.db 1` # timeline 1 some.db
64 # speedup-t3e is a scenario, not a database # links speedup-t3e
64 # my.yaml is a machine, not a database # claims my.yaml
64 # fig6 is a scenario, not a database # report fig6
64 # '' is not the name of a database # query '' 'SELECT 1'
END
}

@test "wrong arguments and options end with 64 and say what was expected" {
    files
    mistaken <<'END'
64 # 'abc' is not the number of a run; `mimdsim query DB # links some.db abc
64 # 'abc' is not the number of a run # timeline some.db abc
64 # '-1' is not the number of a run # links some.db -- -1
64 # unknown option '--forec'; did you mean '--force'? # run speedup-t3e --forec
64 # unknown option '--jons'; did you mean '--jobs'? # run speedup-t3e --jons=3
64 # unexpected argument 'extra' # scenarios extra
64 # --jobs: 'two' is not a number from 1 to 256 # run speedup-t3e --jobs two
64 # requires an argument # run speedup-t3e --jobs
64 # an argument is missing # query some.db
64 # --format: 'svg' is none of picture, text, chrome, paje, csv, goal # timeline fig8 --format svg
64 # expected key=value # run speedup-t3e --set n
64 # --compare needs two machines, not 1 # machines --compare t3e-300
64 # there is no level 'lnik'; did you mean 'link'? # netcheck x.json --level lnik
END
}

@test "bad content ends with 65 and its place, before a database is made" {
    files
    mistaken <<'END'
65 # x.urdf:1: XML # run robot.yaml
65 # x.urdf:1: XML # check x.urdf
65 # x.json:2: # check x.json
65 # plain.txt:1: expected 'key: value' lines # check plain.txt
65 # folder: a folder, not a file # check folder
65 # --set: unknown key 'nn'; did you mean 'n'? # run speedup-t3e --set nn=4
65 # unknown key 'machine.title' here: it cannot be set # run speedup-t3e --set machine.title=x
65 # model.n: '4.5': not a whole number # run speedup-t3e --set n=4.5
65 # model.n: 'x': not a whole number # run speedup-t3e --set n=4,x
65 # n: '4,,8' is not a list; write a sweep as n=2,4,8 # run speedup-t3e --set n=4,,8
65 # ranks: '0': out of range; expected 1 to # run speedup-t3e --set ranks=0
65 # 'lnik': expected one of loggp, link # run speedup-t3e --set level=lnik
65 # plain.txt is not a database of mimdsim # run speedup-t3e -o plain.txt
65 # no such column: nope # query some.db 'SELECT nope FROM run'
65 # more than one statement: 'SELECT 2' would not be run # query some.db 'SELECT 1; SELECT 2'
65 # empty query # query some.db ''
65 # n: not a setting of a machine # machines t3e-300 --set n=4
END
}

@test "what is not there ends with 66 and the nearest name" {
    files
    mistaken <<'END'
66 # no scenario 'speedup-te3'; did you mean 'speedup-t3e'? # run speedup-te3
66 # no file 'speedup-t3.yaml'; did you mean 'speedup-t3e', the scenario of that name? # run speedup-t3.yaml
66 # --machine: no file 't3e-30.yaml'; did you mean 't3e-300', the machine of that name? # run speedup-t3e -m t3e-30.yaml
66 # to mean the file or folder here write './plain.txt', and a scenario ends in .yaml # run plain.txt
66 # badbase.yaml:2: base: no machine 't3e-3000'; did you mean 't3e-300'? # run speedup-t3e -m badbase.yaml
66 # there is no database none.db; `mimdsim run` makes one # query none.db 'SELECT 1'
66 # there is no figure 'fgi6'; did you mean 'fig6'? # plot some.db fgi6
66 # database some.db has no runs for figure 'fig5'; first: mimdsim paper fig5 # plot some.db fig5
66 # there is no run 99 in some.db # timeline some.db 99
66 # some.db has no link loads of run 99 # links some.db 99
66 # no machine 't3e-30'; did you mean 't3e-300'? # validate t3e-30
66 # none.db # claims none.db
73 # folder is a folder; a database is a regular file # run speedup-t3e -o folder
73 # nowhere/x.db # run speedup-t3e -o nowhere/x.db
73 # plain.txt is not a folder # plot some.db fig6 --dir plain.txt
74 # some.db is opened for reading only # query some.db 'DELETE FROM run'
78 # 500 ranks, but machine 't3e-300' has 128 processors # run speedup-t3e --set n=500
END
}

# status_NUMBER: a command that ends with that status; together they are the manual's table.
status_0() { mimdsim scenarios; }
status_1() { mimdsim run speedup-t3e --quiet --set n=128 --set level=loggp --set kernel.precision=float --set kernel.refinement=as-given; }
status_64() { mimdsim run; }
status_65() { mimdsim run speedup-t3e --set n=0; }
status_66() { mimdsim run none; }
status_69() { MIMDSIM_GNUPLOT= PATH=/none "$MIMDSIM" timeline fig8 --format picture; }
status_70() { mimdsim run deadlock --quiet; }
status_71() { (ulimit -v 300000 && mimdsim run speedup-t3e -j 1 --set n=50000 --set machine.topology.dims=64,32,32); }
status_73() { mimdsim run speedup-t3e -o nowhere/x.db; }
status_74() { mimdsim machines >/dev/full; }
status_75() {
    mimdsim run speedup-t3e --quiet --set n=4 -o locked.db
    mkfifo hold
    sqlite3 locked.db <hold >held &
    exec 4>hold
    echo 'BEGIN EXCLUSIVE; SELECT 1;' >&4
    for _ in $(seq 100); do [ -s held ] && break; sleep 0.05; done
    mimdsim run speedup-t3e --quiet --set n=5 -o locked.db
    local found=$?
    exec 4>&-
    wait
    return $found
}
status_78() { mimdsim run speedup-t3e --set n=500; }
status_130() { timeout --preserve-status -s INT 1 "$MIMDSIM" run fig6 --quiet --force --set repetitions=1000 --set machine.noise.compute="1 %" -j 1; }

@test "every exit status of the manual is reached, and means what the manual says" {
    statuses=$(sed -n '/^.SH EXIT STATUS/,/^.SH ENV/p' "$MIMDSIM_SRCDIR/docs/mimdsim.1" | grep -oE '^\.B [0-9]+|^[0-9]+$|^\.BR? "?[0-9]+' |
        grep -oE '[0-9]+')
    [ "$(wc -w <<<"$statuses")" -eq 13 ]
    for number in $statuses; do
        # sanitizers need more memory than the system may refuse
        if [ "$number" = 71 ] && sanitized; then continue; fi
        run --separate-stderr -- "status_$number"
        [ "$status" -eq "$number" ] || { echo "status of status_$number"; show; return 1; }
        [ "$number" != 71 ] || stderr_says "out of memory: the system refuses"
    done
}

@test "an answer that cannot be written is told, whatever the verb" {
    mimdsim run speedup-t3e --quiet --set n=4 --set level=loggp -o some.db >/dev/null
    for command in scenarios kernels machines 'machines t3e-300' plot --help --version 'explain speedup-t3e' \
        'query some.db SELECT+1' 'check my.yaml' 'timeline fig8 --format text' 'plot --json'; do
        echo 'schema_version: 1' >my.yaml; echo 'base: t3e-300' >>my.yaml
        words=($command)
        fails_with 74 bash -c '"$@" >/dev/full' - "$MIMDSIM" "${words[@]//+/ }" || { echo "$command"; return 1; }
        stderr_says "cannot be written"
    done
}

@test "a run whose status is deadlock ends a timeline with 70, and so does the row" {
    fails_with 70 mimdsim timeline deadlock --quiet
    stderr_says "network deadlock: link 0"
    fails_with 70 mimdsim run deadlock --quiet --set record.spans=true
    fails_with 70 mimdsim timeline mimdsim.db 1 --format text
    stderr_says "network deadlock: link 0"
    works mimdsim timeline fig8 --dir a/b --format chrome
    [ -s a/b/timeline.json ]
}
