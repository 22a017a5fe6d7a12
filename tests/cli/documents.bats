#!/usr/bin/env bats
# documents.bats - commands that README and docs/ quote are run, or where they take long or have words to fill in, their
# verbs and options are looked up; files that they name exist.

load helper
load labs.bash

# quoted FILE: the commands of a document, one a line: what is indented by four blanks and begins with the program. A
# description stands behind three blanks or a hash.
quoted() {
    grep -E '^    (\./)?mimdsim ' "$1" | sed -E "s/^    (\.\/)?//; s/ {3,}.*//; s/ +#.*//"
}

# Words to fill in, and what takes longer than a test may.
not_run='[A-Z]{4,}|\.\.\.|\[[A-Z]|\./program|^mimdsim (paper|stability|accuracy|claims|verify|validate|load)|--measure|--uncertainty|n=16384|n=1280|threads'

# look_up COMMAND: its verb exists and has its options.
look_up() {
    local verb options
    verb=${1#* }
    verb=${verb%% *}
    if [ ! -e "help.$verb" ]; then
        works mimdsim "$verb" --help
        printf '%s\n' "$output" >"help.$verb"
    fi
    options=$(printf '%s\n' "$1" | sed -E "s/\"[^\"]*\"//g; s/'[^']*'//g" | grep -oE ' --[a-z][a-z-]*' || true)
    for option in $options; do
        grep -q -e "$option" "help.$verb" || { echo "$verb has no $option: $1"; return 1; }
    done
}

# run_document FILE: its commands, one after the other in one folder.
run_document() {
    local n=0 command
    quoted "$1" >commands
    while read -r command; do
        look_up "$command"
        if printf '%s\n' "$command" | grep -qE "$not_run"; then continue; fi
        (eval "${command/#mimdsim/\"\$MIMDSIM\"}") >out 2>err || { echo "$1: $command"; cat err; return 1; }
        n=$((n + 1))
    done <commands
    [ "$n" -ge "$2" ]
}

# save_block FILE TEXT NAME: the indented block of FILE that follows (or precedes) the line with TEXT, as NAME.
save_block() {
    awk -v text="$2" '/^    schema_version/ { block = ""; on = 1 } on && /^    / { block = block substr($0, 5) "\n" } on && !/^    / { on = 0; last = block }
                      index($0, text) { seen = 1; if (last != "") { printf "%s", last; exit } } seen && !on && last != "" { printf "%s", last; exit }' "$1" >"$3"
    grep -q '^schema_version' "$3"
}

# save_next FILE TEXT NAME: the indented block of FILE behind the line with TEXT, as NAME.
save_next() {
    awk -v text="$2" 'index($0, text) { seen = 1; next } seen && /^    / { print substr($0, 5); block = 1; next } block { exit }' "$1" >"$3"
    grep -q '^schema_version' "$3"
}

@test "the tutorial can be typed as it stands" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    save_block "$MIMDSIM_SRCDIR/docs/tutorial.md" 'Save this as `my.yaml`' my.yaml
    for study in grid sample best links; do
        save_next "$MIMDSIM_SRCDIR/docs/tutorial.md" "Save this as \`$study.yaml\`" $study.yaml
    done
    sed -n '/Save this as `who.sql`/,/Its first column/p' "$MIMDSIM_SRCDIR/docs/tutorial.md" | sed -n 's/^    //p' >who.sql
    # 16 samples of two points take a second
    not_run=${not_run/|--uncertainty/}
    run_document "$MIMDSIM_SRCDIR/docs/tutorial.md" 20
    [ -s figures/slack-1.svg ] || [ -s figures/slack-4.svg ]
    # what it says of the best solver and of the Paragon
    [ "$(sql best.db "SELECT count(*) FROM optimum o JOIN run r ON r.id = o.run_id WHERE r.solver = 'pcr-symmetric'")" = 4 ]
    works mimdsim compare t3e-300 paragon --on speedup-t3e --set n=16,64 --set level=loggp -o first.db
    stdout_says 'B takes 2.9 times as long as A'
    [ "$(sql first.db 'SELECT max(slack_ps) < 1000000 FROM rank_slack')" = 1 ]
    [ -s figures/why-1.svg ] || [ -s figures/why-4.svg ]
    [ -s first.html ] && [ -s zoom/timeline.png ]
    # numbers of its text are those of the runs
    us=$(sql first.db "SELECT printf('%.0f', makespan_ps / 1e6) FROM run WHERE n = 128 AND label = 't3e-300'")
    times=$(sql first.db "SELECT printf('%.2f', speedup) FROM v_run WHERE n = 128 AND name = 't3e-300'")
    grep -q "a simulated time of $us us: $times times" "$MIMDSIM_SRCDIR/docs/tutorial.md"
    works mimdsim why speedup-t3e --set n=128 --set level=link --brief
    receive=$(printf '%s\n' "$output" | grep -oE '[0-9.]+ % is receive overhead' | cut -d' ' -f1)
    grep -q "$receive % of the time is \*receive overhead" "$MIMDSIM_SRCDIR/docs/tutorial.md"
    works mimdsim run links.yaml -o links.db --only 'n >= 64' --columns machine,n,makespan_us,speedup_vs_fastest_serial -q
    [ "${#lines[@]}" -eq 7 ]
    for line in "${lines[@]}"; do grep -qxF "    $line" "$MIMDSIM_SRCDIR/docs/tutorial.md" || { echo "not in the tutorial: $line"; return 1; }; done
    [ "$(wc -l <links.csv)" -eq 13 ]
    # its pictures exist, and each is of this document
    for picture in $(grep -oE '\([a-z-]*\.(svg|png)\)' "$MIMDSIM_SRCDIR/docs/tutorial.md" | tr -d '()'); do
        [ -s "$MIMDSIM_SRCDIR/docs/$picture" ]
    done
}

@test "the commands of README run" {
    if ! command -v gnuplot >/dev/null || ! command -v gcc >/dev/null; then skip; fi
    save_block "$MIMDSIM_SRCDIR/README.md" 'Save it as my.yaml' my.yaml
    works mimdsim check my.yaml
    ln -s "$MIMDSIM_SRCDIR/scenarios" .
    export XDG_CACHE_HOME="$BATS_TEST_TMPDIR"
    # the attempt that it reports on, made and solved as a student would
    works mimdsim lab ring
    solve ring ring
    grep -q '^    ./mimdsim lab report ring ' "$MIMDSIM_SRCDIR/README.md"
    run_document "$MIMDSIM_SRCDIR/README.md" 10
    grep -qF '8 of 8 right' ring/report.html
}

@test "the commands about campaigns, jobs and recorded traffic run" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    run_document "$MIMDSIM_SRCDIR/docs/campaigns.md" 3
    save_block "$MIMDSIM_SRCDIR/docs/jobs.md" 'Save this as `two.yaml`' two.yaml
    run_document "$MIMDSIM_SRCDIR/docs/jobs.md" 5
    run_document "$MIMDSIM_SRCDIR/docs/load.md" 1
    # load curves take long: one point of them
    traffic=$(quoted "$MIMDSIM_SRCDIR/docs/load.md" | grep 'traffic program.db')
    works ${traffic} --rates 0.1 --no-saturation --messages 10000
}

@test "the commands of other documents have verbs and options that exist" {
    for document in "$MIMDSIM_SRCDIR"/docs/*.md; do
        quoted "$document" >commands
        while read -r command; do look_up "$command" || { echo "$document"; return 1; }; done <commands
    done
}

@test "documents that documents name exist" {
    cd "$MIMDSIM_SRCDIR"
    grep -ohE '`(docs|bench|tests|examples|include)/[a-zA-Z0-9_./-]+`' README.md docs/*.md | tr -d '`' | sort -u | while read -r name; do
        [ -e "$name" ] || [ -e "$name.c" ] || { echo "$name"; return 1; }
    done
}

# settings_named: the settings that documents write in full in backquotes, one a line, and those of the table of symbols in
# docs/network.md.
settings_named() {
    grep -ohE '`(machine\.)?(network|node|software|topology|placement|noise|price|power|floor|model|kernel|record)\.[a-z0-9_.]*[a-z0-9_]`' \
        README.md docs/*.md | tr -d '`' | grep -vE '\.(c|h|sql|yaml|md)$'
    awk -F'|' '/^\| symbol \| setting \(`machine.network.`\)/ { on = 1; next } !/^\|/ { on = 0 } on && /`/ { print $3 }' docs/network.md |
        grep -oE '`[a-z_.]+`' | tr -d '`' | sed 's/^/network./'
}

@test "settings that documents name exist" {
    works mimdsim keys
    printf '%s\n' "$output" >keys
    (cd "$MIMDSIM_SRCDIR" && settings_named) | sort -u >named
    [ "$(wc -l <named)" -gt 60 ]
    # in full, or a group of settings
    while read -r name; do
        grep -qE "(^|machine\.)${name//./\\.}([ .]|$)" keys || { echo "$name"; return 1; }
    done <named
}
