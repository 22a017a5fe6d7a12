#!/usr/bin/env bats
# labs_report.bats - the page that is handed in: complete in itself, with every text escaped; in a headless Chromium, where
# there is one, its timeline and sliders by keyboard and mouse.

load helper
load programs.bash
load labs.bash

setup_file() { command -v gcc >/dev/null || skip "no gcc"; }

# solved LAB FOLDER [OPTION...]
solved() {
    works mimdsim lab "$1" "$2" "${@:3}"
    solve "$2" "$1"
}

# browse FILE: what the page is after its scripts have run, in the file `seen`.
browse() {
    local browser
    browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || skip "no Chromium"
    timeout 600 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$PWD/profile" \
        --window-size="${width:-1200},900" --virtual-time-budget=3000 --dump-dom "file://$PWD/$1" >seen 2>browser-said || { tail browser-said; return 1; }
}

# act FILE: a copy acted.html of the page without its policy, in which the script on standard input acts as a reader would;
# what it hands to out() is in `seen` as lines "out: ...".
act() {
    {
        sed 's/<meta http-equiv="Content-Security-Policy"[^>]*>//; /^<\/body>/,$d' "$1"
        cat <<'S'
<pre id="out"></pre><script>
var svg = document.getElementById('timeline'), all = [];
function out(text) { all.push('out: ' + text); document.getElementById('out').textContent = all.join('\n'); }
function key(k) { svg.dispatchEvent(new KeyboardEvent('keydown', {key: k, bubbles: true, cancelable: true})); }
function said() { return document.getElementById('said').textContent; }
function count(what) { return svg.querySelectorAll(what).length; }
function slide(i, to) { var s = document.getElementById('slider-' + i); s.value = to; s.dispatchEvent(new Event('input')); }
function result() { return document.getElementById('result').textContent; }
S
        cat
        echo '</script></body></html>'
    } >acted.html
    browse acted.html
}

# out TEXT: a line of the actions.
out() { grep -qF "out: $1" seen || { echo "not there: $1"; grep -a 'out: ' seen; return 1; }; }

@test "the page has the answers, the path, the program and the notes, and needs nothing beside it" {
    solved ring it --variant 'Ann <b>&amp;'
    printf 'I would halve L: </div><script>alert(1)</script> & more\n' >it/notes.md
    works mimdsim lab report it && stdout_is it/report.html
    page=it/report.html
    grep -qF '<strong>8 of 8 right.</strong>' $page
    grep -qF 'variant of <strong>Ann &lt;b&gt;&amp;amp;</strong>' $page
    grep -qF 'I would halve L: &lt;/div&gt;&lt;script&gt;alert(1)' $page
    grep -qF 'comm_recv(c, me - 1, 0, token, bytes);' $page
    # one script, ours, told to the browser; nothing is fetched
    [ "$(grep -o '<script' $page | wc -l)" -eq 2 ]
    [ "$(grep -c '<script type="application/json" id="data">' $page)" -eq 1 ]
    grep -q "Content-Security-Policy.*default-src 'none'.*script-src 'sha256-" $page
    ! grep -oE '(src|href|url)[=(]["'\'']?(https?:|//|file:)' $page
    # the parts of the critical path add up to the time that the check has
    grep -qE '<td>end latency</td><td class="number">[0-9]' $page
    # the same page every time, and no second one of an attempt that is none
    cp $page first.html
    works mimdsim lab report it && cmp first.html $page
    fails_with 66 mimdsim lab report nowhere
    fails_with 64 mimdsim lab report it it
    [ ! -e nowhere ]
}

@test "a program that does not end, and wrong answers, have a page as well" {
    works mimdsim lab deadlock it
    answer it messages 3
    fails_with 1 mimdsim lab report it
    grep -qF '0 of 4 right' it/report.html
    grep -q 'Program: deadlock: ' it/report.html
    ! grep -q '<script' it/report.html
    grep -qF 'no prediction yet' it/report.html
    # an attempt that names no lesson is refused
    echo 'lab: nothing' >it/answers.yaml
    fails_with 66 mimdsim lab report it
}

@test "every lesson's report has a run for each place of its sliders" {
    for lab in broadcast sample-sort dynamics; do
        solved $lab $lab
        works mimdsim lab report $lab
        # what the data say, by a reader of JSON that is not ours
        sed -n 's/.*id="data">\(.*\)/\1/p' $lab/report.html | sed 's/<\/script>.*//' >data.json
        works sqlite3 :memory: "SELECT json_array_length(j, '\$.runs'), json_array_length(j, '\$.grid'), json_array_length(j, '\$.grid[0]'),
            (SELECT exp(sum(ln(json_array_length(value, '\$.values')))) FROM json_each(j, '\$.sliders')),
            (SELECT count(*) FROM json_each(j, '\$.grid[0]') WHERE type = 'null')
            FROM (SELECT CAST(readfile('data.json') AS TEXT) AS j)"
        IFS='|' read -r runs grids points product refused <<<"$output"
        [ "$runs" -eq "$grids" ] && [ "${product%.*}" -ge $((points - 1)) ] && [ "$points" -gt 20 ] && [ "$refused" -eq 0 ]
    done
}

@test "grade is a table for spreadsheets, too, in which no name is a formula" {
    solved ring a --variant '=1+1'
    works mimdsim lab grade a --csv
    [ "${lines[0]//$'\r'/}" = folder,lab,student,right,questions,program ]
    [ "${lines[1]//$'\r'/}" = "a,ring,'=1+1,8,8,ok" ]
    works mimdsim lab --grade a && grep -q '^a .* ok$' <<<"$output"
    fails_with 66 mimdsim lab --grade a none
}

@test "in a browser: the timeline by keyboard and mouse, the sliders" {
    solved ring it --variant ann
    works mimdsim lab report it
    # the page as it is, with its policy
    browse it/report.html
    grep -q '<html[^>]*data-ready="yes"' seen
    P=$(number it ranks)
    act it/report.html <<'E'
out('spans ' + (count('rect.span') > 0) + ', path ' + (count('.path') > 0) + ', rows ' + count('.row:not(.current)'));
out('whole: ' + said());
var before = count('rect.span');
key('+'); key('+'); key('+');
out('zoomed: ' + said());
out('fewer: ' + (count('rect.span') < before));
key('ArrowRight'); out('later: ' + said());
key('ArrowLeft'); key('ArrowLeft'); key('Home'); out('back: ' + (count('rect.span') === before));
key('ArrowDown'); out('chosen: ' + said());
key('n'); out('first: ' + said());
key('n'); out('second: ' + said());
key('c'); out('step: ' + said());
key('C'); key('C'); out('still: ' + said());
document.querySelector('[data-do=zoom-in]').click(); out('button: ' + said());
svg.dispatchEvent(new WheelEvent('wheel', {deltaY: 100, clientX: 300, bubbles: true, cancelable: true}));
key('Home');
svg.querySelector('rect.span').dispatchEvent(new MouseEvent('click', {bubbles: true})); out('clicked: ' + said());
out('focus: ' + (function () { svg.focus(); return document.activeElement === svg; })());
out('names: ' + Array.from(document.querySelectorAll('input,select')).every(function (i) { return document.querySelector('label[for=' + i.id + ']'); }));
out('mine: ' + result());
slide(0, 0); out('no latency: ' + result());
out('shares: ' + Array.from(document.querySelectorAll('#shares tr')).map(function (r) { return r.cells[0].textContent; }).join('|'));
document.getElementById('own').click(); out('again: ' + result());
E
    local one whole L b G o
    L=$(number it end_latency) o=$(number it send) G=$(number it gap_per_byte) b=$(number it bytes)
    us() { awk -v ps="$1" 'BEGIN { s = sprintf("%.6f", ps / 1e6); sub(/0+$/, "", s); sub(/\.$/, "", s); print s }'; }
    one=$(((2 * o + L) * 1000000 + (b - 1) * G * 1000)) whole=$((P * one))
    out "spans true, path true, rows $P"
    out "whole: From 0 µs to $(us $whole) µs of $(us $whole) µs."
    out "zoomed: From $(us $((whole * 7 / 16))) µs to $(us $((whole * 9 / 16))) µs"
    out 'fewer: true'
    out "later: From $(us $((whole * 15 / 32))) µs"
    out 'back: true'
    out 'chosen: Rank 1.'
    out "first: Rank 1, waiting from 0 µs to $(us $((one - o * 1000000))) µs"
    out "second: Rank 1, receiving from $(us $((one - o * 1000000))) µs to $(us $one) µs, for $o µs; with rank 0; $b bytes."
    out "step: Critical path, step 1 of"
    out 'still: Critical path, step 1 of'
    out 'clicked: Rank 0, sending from 0 µs'
    out 'focus: true'
    out 'names: true'
    out "mine: $(us $whole) µs, that is 1 times yours"
    out "no latency: $(us $((whole - P * L * 1000000))) µs, that is "
    out 'shares: send overhead|receive overhead|injection bandwidth'
    out "again: $(us $whole) µs, that is 1 times yours"
}

@test "in a browser half as wide the page is not wider than its window" {
    solved cannon it --variant ann
    works mimdsim lab report it
    width=600
    act it/report.html <<'E'
out('window ' + document.documentElement.clientWidth + ', page ' + document.documentElement.scrollWidth);
out('fits: ' + (document.documentElement.scrollWidth <= document.documentElement.clientWidth));
E
    out 'fits: true'
}
