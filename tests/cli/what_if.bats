#!/usr/bin/env bats
# what_if.bats - scenarios with `answer:`: sentences computed from the rows, pictures, the questions of docs/what-if.md with
# the answers that stand there, and files that ask in a wrong way.

load helper

# A small scenario with the answer $1.
asks() {
    cat >ask.yaml <<END
schema_version: 1
question: Which one?
machine: t3e-300
kernel: {name: pingpong}
level: loggp
ranks: 2
sweep:
  kernel.message: [8 B, 1024 B, 65536 B]
  variant:
  - {name: plain}
  - {name: slow start, machine.network.end_latency: 20 us}
  - {name: slow wire, machine.network.link.bandwidth: 5 MB/s}
answer: $1
END
}

# The sentence behind the question on standard output.
sentence() { printf '%s\n' "$output" | awk 'seen { print; exit } $0 == "Which one?" { seen = 1 }'; }

# makespan of variant $1 at message size $2 in microseconds, by the rows alone.
us() {
    sql ask.db "SELECT r.makespan_ps / 1e6 FROM run r JOIN v_setting s ON s.run_id = r.id AND s.key = 'kernel.message'
                WHERE r.label = '$1' AND s.number = $2"
}

@test "the best, with the ratio to the next: as the rows have it" {
    asks '{of: variant, over: kernel.message, least: makespan}'
    works mimdsim run ask.yaml -o ask.db
    [[ $(sentence) == "'plain' has the least makespan for kernel.message 8 B to 64 KiB (the next: "* ]]
    # 8 B: the slow wire is next
    ratio=$(sql :memory: "SELECT printf('%.3g', $(us 'slow wire' 8) / $(us plain 8))")
    [[ $(sentence) == *"$ratio"* ]]
    stdout_says "figures/ask.png"
    [ -s figures/ask.svg ] && [ -s figures/ask.csv ]
}

@test "against one of them: the others are compared with it, and among each other" {
    asks '{of: variant, over: kernel.message, least: makespan, against: plain}'
    works mimdsim run ask.yaml -o ask.db --dir here
    # where the two curves cross is in the rows
    [[ $(sentence) == "beside 'plain', 'slow wire' has the least makespan for kernel.message 8 B"*", 'slow start' for kernel.message 1 KiB to 64 KiB"* ]]
    least=$(sql :memory: "SELECT printf('%.3g', $(us 'slow start' 65536) / $(us plain 65536))")
    most=$(sql :memory: "SELECT printf('%.3g', $(us 'slow start' 8) / $(us plain 8))")
    [[ $(sentence) == *"against 'plain' makespan is $least to $most times with 'slow start'"* ]]
    [ -s here/ask.svg ]
}

@test "within a share; greatest; one value without 'over'; formulas" {
    asks '{of: variant, over: kernel.message, least: makespan, against: plain, within: 60 %}'
    works mimdsim run ask.yaml -o ask.db
    # in the order of the file the slow start comes first: it is too much for the short ones
    [[ $(sentence) == *"within 60 % of 'plain': only 'plain' for kernel.message 8 B"* ]]
    asks '{of: variant, over: kernel.message, least: makespan, against: slow start, within: 10 %}'
    works mimdsim run ask.yaml -o ask.db
    [[ $(sentence) == *"within 10 % of 'slow start': up to 'slow wire' for kernel.message 8 B"*"only 'slow start' for kernel.message 1 KiB to 64 KiB." ]]
    asks '{of: variant, over: kernel.message, greatest: 1 / makespan}'
    works mimdsim run ask.yaml -o ask.db
    [[ $(sentence) == "'plain' has the greatest 1 / makespan for"*" (the next: 0."* ]]
    asks '{of: kernel.message, least: makespan}'
    works mimdsim run ask.yaml -o one.db --only "machine.network.end_latency < 10 us and machine.network.link.bandwidth > 100 MB/s"
    [[ $(sentence) == "'8 B' has the least makespan (the next: "* ]]
    [ -s figures/ask.svg ]
}

# texts_are FILE TEXT...: the drawing has each of these texts.
texts_are() {
    local file=$1 text
    shift
    for text; do grep -qF "<text>$text<" "$file" || { echo "not in $file: $text"; grep -o '<text>[^<]*' "$file"; return 1; }; done
}

@test "axes and curves of the picture are called as the file calls them, with their units" {
    asks '{of: variant, over: kernel.message, least: makespan}'
    works mimdsim run ask.yaml -o ask.db
    texts_are figures/ask.svg 'kernel.message [B]' 'run time [ms]' 'slow wire'
    asks '{of: variant, over: kernel.message, least: 184 * makespan * makespan, called: "energy x time [J s]"}'
    works mimdsim run ask.yaml -o ask.db
    [[ $(sentence) == "'plain' has the least energy x time for kernel.message"* ]]
    # numbers of six letters leave room for it
    texts_are figures/ask.svg 'energy x time [J s]'
    # without a name the formula is one, and a unit that it has is told
    asks '{of: variant, over: machine.network.link.bandwidth, greatest: 1 / makespan}'
    sed -i 's|^  kernel.message:.*|  machine.network.link.bandwidth: [100 MB/s, 400 MB/s]|; s|name: slow wire.*|name: far, machine.network.hop_latency: 1 us}|' ask.yaml
    works mimdsim run ask.yaml -o two.db
    texts_are figures/ask.svg '1 / makespan' 'link.bandwidth [MB/s]'
    sed -i 's|^  machine.network.link.bandwidth:.*|  machine.noise.compute: [1 %, 25 %]|; s|^answer.*|answer: {of: variant, over: machine.noise.compute, least: makespan}|' ask.yaml
    works mimdsim run ask.yaml -o three.db
    texts_are figures/ask.svg 'noise.compute [%]'
    asks '{of: variant, over: kernel.message, least: makespan, called: ""}'
    fails_with 65 mimdsim run ask.yaml -o ask.db
    stderr_says "answer: called: '': expected a text"
}

@test "for programs there are rows alone; parts of a plan answer nothing" {
    asks '{of: variant, over: kernel.message, least: makespan}'
    works mimdsim run ask.yaml -o ask.db --json
    json_is_valid
    works mimdsim run ask.yaml -o ask.db --csv
    [[ $output != *"has the least"* ]]
    works mimdsim run ask.yaml -o ask.db --shard 1/2
    [[ $output != *"has the least"* ]]
    [ ! -e figures ]
}

@test "answers that make no sense are refused with file and line" {
    asks '{of: variannt, over: kernel.message, least: makespan}'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "ask.yaml:13: answer: 'variannt' is not swept"
    asks '{of: variant, over: kernel.repeat, least: makespan}'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "'kernel.repeat' is not swept"
    asks '{of: variant}'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "the goal is missing"
    asks '{least: makespan}'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "'of' is missing"
    asks '{of: variant, least: makespan, greatest: speedup}'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "one goal"
    asks '{of: variant, least: makespan, within: 5 %}'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "'within' needs 'against'"
    asks '{of: variant, least: makespan, against: plain, within: -5 %}'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "expected above 0 %"
    asks '{of: variant, leest: makespan}'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "unknown key 'leest'; did you mean 'least'?"
    asks '[a, b]'
    fails_with 65 mimdsim check ask.yaml
    stderr_says "expected {of: variant, over: n, least: makespan}"
    asks '{of: variant, least: makespam}'
    fails_with 65 mimdsim run ask.yaml -o ask.db
    stderr_says "did you mean 'makespan'?"
    [ ! -e ask.db ]
    asks '{of: variant, least: makespan, against: plan}'
    fails_with 65 mimdsim run ask.yaml -o ask.db
    stderr_says "no run has 'plan' for variant; did you mean 'plain'?"
}

@test "an answer out of more values than can be compared is refused before the first run" {
    printf '%s\n' 'schema_version: 1' 'machine: ideal' 'machine.topology.dims: [8192]' 'kernel: barrier' "ranks: [$(seq -s, 2 4098)]" \
        'answer: {of: ranks, over: ranks, least: makespan}' >ask.yaml
    fails_with 78 mimdsim run ask.yaml -o ask.db --quiet
    stderr_says "ask.yaml:6: answer: 1025 values of 'ranks' for each of 1025 of 'ranks', or more, are too many to compare"
    [ ! -e ask.db ]
    sed -i 's/over: ranks, //' ask.yaml
    fails_with 78 mimdsim run ask.yaml -o ask.db --quiet
    stderr_says "answer: 4097 values of 'ranks', or more, are too many to compare"
}

@test "the questions of docs/what-if.md have the answers that stand there" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    tr '\n' ' ' <"$MIMDSIM_SRCDIR/docs/what-if.md" | tr -s ' ' >words
    n=0
    for file in "$MIMDSIM_DATA"/scenarios/what-if-*.yaml; do
        name=$(basename "$file" .yaml)
        works mimdsim run "$name" -o "$name.db" --quiet
        question=$(grep '^question: ' "$file" | cut -d' ' -f2-)
        said=$(printf '%s\n' "$output" | awk -v q="$question" 'seen { print; exit } $0 == q { seen = 1 }')
        [ -n "$said" ]
        grep -qF -e "mimdsim run $name " words || { echo "no command for $name"; return 1; }
        grep -qF -e "$said" words || { echo "docs/what-if.md lacks of $name: $said"; return 1; }
        [ -s "figures/$name.svg" ]
        n=$((n + 1))
    done
    [ "$n" -ge 10 ]
}
