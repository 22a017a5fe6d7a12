#!/usr/bin/env bats
# docs_figures.bats - the figures in docs/ are those that this program draws today, and each names the commit it is from.

load helper

# without_stamp FILE: a drawing without the line that says who made it.
without_stamp() { sed -E 's/(error of level|mimdsim [0-9]).*//' "$1"; }

# compare DIR: whether the figures in docs/ are those in DIR.
compare() {
    local figure name stale=0
    for figure in "$MIMDSIM_SRCDIR"/docs/*.svg; do
        name=$(basename "$figure")
        [ -e "$1/$name" ] || { echo "docs/figures.sh does not draw $name"; return 1; }
        diff <(without_stamp "$figure") <(without_stamp "$1/$name") >difference ||
            { echo "docs/$name is stale; \`docs/figures.sh docs\` draws it"; head -4 difference; stale=1; }
    done
    return "$stale"
}

@test "the figures in docs/ are not stale" {
    # gnuplot of another version draws other bytes
    [ "$(gnuplot --version 2>&1)" = 'gnuplot 5.4 patchlevel 4' ] || skip 'no gnuplot 5.4 patchlevel 4'
    MIMDSIM=$MIMDSIM sh "$MIMDSIM_SRCDIR/docs/figures.sh" drawn
    compare drawn
    # and one that is would be found
    sed -i '0,/<path /s//<path  /' drawn/speedup-t3e.svg
    run compare drawn
    [ "$status" -eq 1 ]
    [[ $output == *'docs/speedup-t3e.svg is stale'* ]]
}

@test "the stamp of each figure in docs/ names a commit of this history" {
    for figure in "$MIMDSIM_SRCDIR"/docs/*.svg; do
        commit=$(grep -Eo 'mimdsim [0-9.]+ \([0-9a-f]{12}\)' "$figure" | sed -E 's/.*\((.*)\)/\1/')
        [ -n "$commit" ] || { echo "$figure names no commit without changes"; return 1; }
        if [ -e "$MIMDSIM_SRCDIR/.git" ] && [ "$(git -C "$MIMDSIM_SRCDIR" rev-parse --is-shallow-repository)" = false ]; then
            git -C "$MIMDSIM_SRCDIR" cat-file -e "$commit^{commit}" || { echo "$figure: $commit is no commit"; return 1; }
        fi
    done
}
