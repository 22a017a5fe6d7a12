#!/usr/bin/env bats
# hostile.bats - what is no file, names that lead elsewhere, texts that would be commands: each is refused or shown as it is.

load helper

# soon COMMAND...: COMMAND must end by itself, soon even on a slow computer with sanitizers, and in little memory.
soon() {
    if [ "${memory:-}" = "" ]; then
        memory=2000000
        (ulimit -v $memory; mimdsim --version) >/dev/null 2>&1 || memory=unlimited # sanitizers reserve more
    fi
    (ulimit -v $memory; exec timeout 100 "$@")
}

@test "a pipe, a device, a folder and a socket are no files, whoever is asked to read them" {
    mkfifo pipe.yaml pipe.json
    mkdir folder
    for verb in check explain run plan netcheck verify why timeline programs; do
        for file in ./pipe.yaml ./pipe.json /dev/zero /dev/stdin ./folder; do
            run --separate-stderr -- soon "$MIMDSIM" $verb $file </dev/zero
            # programs lists what is there and looks into nothing else
            if [ "$verb" = programs ]; then [ "$status" -ne 124 ]; continue; fi
            case $status in 64 | 65 | 66) ;; *) echo "$verb $file"; show; return 1 ;; esac
            case $stderr in *"not a file"* | *"a folder"* | *"is a device"* | *"not a text file"*) ;; *) echo "$verb $file"; show; return 1 ;; esac
        done
    done
    # where a file names another
    for file in ./pipe.yaml /dev/zero ./folder; do
        case $file in /*) path=$file ;; *) path=$PWD/${file#./} ;; esac
        printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'kernel: dynamics' 'ranks: 2' \
            "model: {generator: urdf, path: $path}" >urdf.yaml
        printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'kernel: dynamics' 'ranks: 2' \
            "model: {generator: vector, path: $path}" >vector.yaml
        printf '%s\n' 'schema_version: 1' "machine: $path" 'kernel: dynamics' 'ranks: 2' >machine.yaml
        printf '%s\n' "base: $path" 'title: x' >base.yaml
        printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'ranks: 2' "program: $path" >program.yaml
        for verb in check run explain; do
            for scenario in urdf vector machine base program; do
                run --separate-stderr -- soon "$MIMDSIM" $verb $scenario.yaml
                case $status in 64 | 65 | 66 | 78) ;; *) echo "$verb $scenario.yaml: $file"; show; return 1 ;; esac
            done
        done
    done
    # a compiler would wait for its text
    mkfifo pipe.c
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'ranks: 2' 'program: pipe.c' >program.yaml
    for verb in check run explain; do
        run --separate-stderr -- soon "$MIMDSIM" $verb program.yaml
        [ "$status" -eq 65 ] || { echo "$verb program.yaml"; show; return 1; }
        stderr_says "pipe.c: a pipe, not a file"
    done
    rm ./*.yaml ./*.json pipe.c
    rmdir folder
    nothing_left_behind
}

@test "a pipe, a device or a socket is no database, whoever is asked to read or write it" {
    mkfifo pipe.db
    for file in pipe.db /dev/zero /dev/null; do
        for verb in 'query $ select' 'report $' 'plot $ fig5' 'timeline $ 1' 'why $ 1' 'links $ 1' 'load t3e-300 --traffic $:1' \
            'run speedup-t3e -o $' 'claims $'; do
            # shellcheck disable=SC2086
            run --separate-stderr -- soon "$MIMDSIM" ${verb//$/$file}
            case $status in 65 | 73) ;; *) echo "$verb"; show; return 1 ;; esac
            case $file in pipe.db) stderr_says 'pipe.db is a pipe; a database is a regular file' ;; *) stderr_says "$file is a device; a database is a regular file" ;; esac
        done
    done
    rm pipe.db
    nothing_left_behind
}

@test "a file that is larger than a text may be is refused before it is read" {
    truncate -s 600M large.json
    truncate -s 5G large.yaml
    truncate -s 200G large.urdf
    fails_with 65 soon "$MIMDSIM" verify large.json
    stderr_says 'not a text file of at most 512 MiB'
    fails_with 65 soon "$MIMDSIM" run large.yaml
    stderr_says 'not a text file of at most 4 MiB'
    run --separate-stderr -- soon "$MIMDSIM" check large.urdf
    case $status in 65 | 78) ;; *) show; return 1 ;; esac
}

@test "a report that fails leaves the older one as it was" {
    works mimdsim run speedup-t3e --set n=4 --set ranks=2 -o some.db --quiet
    works mimdsim report some.db
    sum=$(cat some.md some.html | cksum)
    # the report of a limited size of files: every other file is smaller
    size=$(stat -c %s some.html)
    limited() { (ulimit -f $((size / 1024 - 8)); mimdsim "$@"); }
    fails_with 74 limited report some.db
    stderr_says 'some.html failed: File too large'
    [ "$(cat some.md some.html | cksum)" = "$sum" ]
    [ -z "$(find . -name '*.part')" ]
    # a link is followed: what it leads to gets the new report, and stays where it is
    works mimdsim run speedup-t3e --set n=4 --set ranks=2 -o other.db --quiet
    mkdir elsewhere
    echo old >elsewhere/other.md
    chmod 600 elsewhere/other.md
    ln -s elsewhere/other.md other.md
    works mimdsim report other.db
    [ -L other.md ] && grep -q 'What other.db holds' elsewhere/other.md
    [ "$(stat -c %a elsewhere/other.md)" = 600 ]
}

@test "no text of a scenario, a machine, a database or the command line moves a terminal" {
    esc=$(printf '\033')
    mkdir -p .local "$XDG_DATA_HOME/mimdsim/scenarios"
    printf '%s\n' 'schema_version: 1' 'question: "is it \e[31mred\e[0m, \u009b31m or \u202etxt?"' 'machine: t3e-300' \
        'kernel: dynamics' 'n: 4' 'ranks: 2' >own.yaml
    cp own.yaml "$XDG_DATA_HOME/mimdsim/scenarios/own.yaml"
    printf '%s\n' 'base: t3e-300' 'title: "\e]0;title\a"' >machine.yaml
    clean() { # COMMAND...: whatever it says and ends with, nothing of it is a command of a terminal
        run --separate-stderr -- "$@"
        # C0 but for line ends and tabs, DEL, C1, and the signs of direction
        if printf '%s\n%s\n' "$output" "$stderr" | LC_ALL=C grep -qP '[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\xaa-\xae]'; then
            echo "$*"
            show
            return 1
        fi
    }
    for verb in check explain plan; do
        clean mimdsim $verb own.yaml
        clean mimdsim $verb own.yaml --json
    done
    clean mimdsim explain own.yaml
    stdout_says 'is it \u001b[31mred\u001b[0m, \u009b31m or \u202etxt?'
    clean mimdsim scenarios
    clean mimdsim machines machine.yaml
    clean mimdsim run own.yaml --machine machine.yaml -o t.db
    clean mimdsim run own.yaml -o t.db
    clean mimdsim run "no$esc[31m.yaml"
    clean mimdsim run own.yaml --set "n=$esc[31m"
    clean mimdsim run own.yaml --set "$esc[31m=1"
    clean mimdsim "$esc[31m"
    clean mimdsim query t.db "SELECT '$esc[31m' AS a, char(155) || '31m' AS b"
    stdout_says 'u009b31m'
    printf '%s\n' 'schema_version: 1' "bad$(printf '\302\233')key: 1" >bad.yaml
    clean mimdsim check bad.yaml
    sqlite3 t.db "UPDATE run SET scenario = 'a' || char(27) || '[31m', machine = 'b' || char(155)"
    for verb in report plot links why timeline check; do clean mimdsim $verb t.db; done
    clean mimdsim plot t.db fig6
    # a document stays what it was: the same text comes back
    works mimdsim query t.db 'SELECT scenario FROM run' --json
    json_is '$[0].scenario' "a$esc[31m"
    ! grep -q "$esc" t.md t.html
}

@test "compiled programs are kept in a folder of the user's, not in one of the root" {
    command -v gcc >/dev/null || skip "no gcc"
    works mimdsim new first
    fails_with 78 env -u XDG_CACHE_HOME -u HOME "$MIMDSIM" run first.c -o t.db
    stderr_says 'neither XDG_CACHE_HOME nor HOME is set'
    fails_with 78 env -u XDG_CACHE_HOME HOME= "$MIMDSIM" run first.c -o t.db
    [ ! -e /.cache/mimdsim ] && [ ! -e t.db ]
}

@test "a closed pipe ends a campaign's table as it ends any other program" {
    set +o pipefail
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'kernel: dynamics' 'n: 4' 'ranks: [1, 2]' >own.yaml
    status=$(sh -c '{ "$1" run own.yaml -o t.db --jobs 2 --quiet; echo $? >&3; } 3>&2 2>err | :' - "$MIMDSIM" 2>&1)
    # 141: by the signal; a message about the output would be one too many
    [ "$status" = 141 ] && [ ! -s err ]
}

@test "a campaign that is interrupted says what stays, and goes on from there" {
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'kernel: dynamics' 'n: [64, 96, 128, 160, 192]' 'ranks: [16, 32, 64]' \
        'level: flit' >own.yaml
    "$MIMDSIM" run own.yaml -o t.db --jobs 2 --quiet >/dev/null 2>err &
    pid=$!
    for _ in $(seq 200); do
        [ -e t.db ] && [ "$(sql t.db 'SELECT count(*) FROM run' 2>/dev/null)" -ge 1 ] 2>/dev/null && break
        sleep 0.05
    done
    kill -TERM $pid
    status=0
    wait $pid || status=$?
    [ "$status" -eq 143 ]
    grep -q 'interrupted: what is stored stays, and the same command goes on from there' err
    [ "$(grep -c interrupted err)" = 1 ]
    sql_is t.db 'PRAGMA integrity_check' ok
}
