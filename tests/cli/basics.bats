#!/usr/bin/env bats
# basics.bats - verbs, help, version, wrong options.

load helper

verbs() { "$MIMDSIM" --help | awk '/^  [a-z]+ / && $1 != "mimdsim" { print $1 }'; }

@test "without a verb the help goes to stderr with status 64" {
    fails_with 64 mimdsim
    stdout_is_empty
    stderr_says "Usage: mimdsim VERB"
}

@test "--help lists the verbs on stdout" {
    works mimdsim --help
    stderr_is_empty
    for verb in run plot check explain machines scenarios kernels; do stdout_says "  $verb "; done
}

@test "every verb tells its purpose with an example" {
    [ "$(verbs | wc -l)" -ge 7 ]
    for verb in $(verbs); do
        works mimdsim "$verb" --help
        stdout_says "Example: mimdsim $verb"
        stdout_says "Usage: mimdsim $verb"
        stderr_is_empty
    done
}

@test "-h and help do as --help" {
    works mimdsim run --help
    said=$output
    works mimdsim run -h
    stdout_is "$said"
    works mimdsim help run
    stdout_is "$said"
    works mimdsim -h
    stdout_says "Usage: mimdsim VERB"
    fails_with 64 mimdsim help rnu
    fails_with 64 mimdsim --verson
    stderr_says "did you mean '--version'?"
}

@test "every verb is in the manual, and so is every long option" {
    for verb in $(verbs); do
        grep -q "^\.B[IR]* \"\?$verb" "$MIMDSIM_SRCDIR/docs/mimdsim.1" || { echo "no $verb in the manual"; return 1; }
        for option in $("$MIMDSIM" "$verb" --help | grep -o -e '--[a-z-]*[a-z]' | sort -u); do
            case $option in --usage) continue ;; esac
            sed 's/\\-/-/g' "$MIMDSIM_SRCDIR/docs/mimdsim.1" | grep -q -e "$option" ||
                { echo "no $option (of $verb) in the manual"; return 1; }
        done
    done
}

@test "--version tells version, source and compiler" {
    works mimdsim --version
    [[ $output =~ ^mimdsim\ [0-9]+\.[0-9]+\.[0-9]+ ]]
    stdout_says "built by"
    stderr_is_empty
}

@test "an unknown verb is refused with the nearest one" {
    fails_with 64 mimdsim rnu
    stdout_is_empty
    stderr_says "'rnu' is not a verb; did you mean 'run'?"
}

@test "an unknown option of any verb is refused with status 64" {
    for verb in $(verbs); do
        [ "$verb" != cc ] || continue  # its options are gcc's
        fails_with 64 mimdsim "$verb" --no-such-option
        stdout_is_empty
        stderr_says "no-such-option"
    done
}

@test "a missing argument is refused with status 64" {
    for verb in run explain check; do
        fails_with 64 mimdsim "$verb"
        stdout_is_empty
        stderr_says "argument is missing"
    done
    nothing_left_behind
}

@test "every key of a scenario is told, with its values and its default" {
    works mimdsim scenarios --keys
    for word in '`kernel.solver`' 'of the block tridiagonal system' 'default pcr-symmetric' '`sweep`' '`record.spans`' \
        auto-tolerance; do
        stdout_says "$word"
    done
    works mimdsim scenarios --keys --json
    json_is_valid
    stdout_says '"kernel.solver"'
    # what it says of lists, short names and dots holds
    printf '%s\n' 'schema_version: 1' 'question: One?' 'machine: t3e-300' 'model: {generator: serial-chain}' \
        'kernel.formulation: direct' 'n: [4, 8]' 'ranks: [2, 8]' 'only: n >= ranks' 'level: loggp' 'kernel: dynamics' \
        'sweep: {kernel.solver: [cr, pcr]}' >own.yaml
    works mimdsim run own.yaml -o own.db --quiet
    sql_is own.db "SELECT count(*), count(DISTINCT solver), sum(formulation = 'direct') FROM run" '6|2|6'
}

@test "the lists of machines, scenarios and kernels are not empty, for people and as JSON" {
    for verb in machines scenarios kernels; do
        works mimdsim "$verb"
        [ "${#lines[@]}" -ge 1 ]
        stderr_is_empty
        works mimdsim "$verb" --json
        json_is_valid
        stderr_is_empty
    done
    nothing_left_behind
}
