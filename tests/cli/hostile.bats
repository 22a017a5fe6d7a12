#!/usr/bin/env bats
# hostile.bats - what is no file, names that lead elsewhere, texts that would be commands: each is refused or shown as it is.

load helper

# soon COMMAND...: COMMAND must end by itself, within some seconds and in little memory.
soon() {
    if [ "${memory:-}" = "" ]; then
        memory=2000000
        (ulimit -v $memory; mimdsim --version) >/dev/null 2>&1 || memory=unlimited # sanitizers reserve more
    fi
    (ulimit -v $memory; exec timeout 20 "$@")
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
    rm ./*.yaml ./*.json
    rmdir folder
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
