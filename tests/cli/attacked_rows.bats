#!/usr/bin/env bats
# attacked_rows.bats - texts of a database that choose the rows of figures, as attacks.bats has those that figures show.

load helper
load attacks

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
