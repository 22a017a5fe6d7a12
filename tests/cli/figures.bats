# figures.bats - the figures whose rows no made run has, drawn from runs that the program really makes, and what must be
# seen in them. The other figures are drawn by tests/report/test_figure.c, which names those that it leaves to this file.
load helper

setup_file() {
    cd "$BATS_FILE_TMPDIR" || return 1
    small_mesh "4, 4"
    {
        "$MIMDSIM" why speedup-t3e --set n=16 --set level=link -o real.db --quiet
        "$MIMDSIM" load small.yaml --rates 0.05,0.2,0.4 --traffic uniform -o real.db --quiet
        "$MIMDSIM" run speedup-t3e --set n=8 --set level=loggp --uncertainty 8 -o real.db --quiet
        "$MIMDSIM" run bisection --set ranks=16 --set level=link -o real.db --quiet
        "$MIMDSIM" run pingpong-machines --set machine=t3e-300,paragon -o real.db --quiet
        "$MIMDSIM" run "$MIMDSIM_SRCDIR/examples/ring-allreduce.yaml" -o real.db --quiet --set ranks=2,4
    } >setup.out 2>&1 || { cat setup.out; return 1; }
}

# drawn FIGURE: every picture of it is there, whole, and in both formats; their names without endings in $pictures.
drawn() {
    works mimdsim plot "$BATS_FILE_TMPDIR/real.db" "$1"
    pictures=${output//.png/}
    for picture in $pictures; do
        tail -c 12 "$picture.png" | grep -aq IEND
        tail -c 8 "$picture.svg" | grep -q '</svg>'
        [ "$(grep -c '<path' "$picture.svg")" -gt 5 ]
        # the name of a vertical axis is not cut at the left edge
        grep -oE 'translate\([-0-9.]+,[-0-9.]+\) rotate\(270\)' "$picture.svg" | tr -c '0-9.\n-' ' ' | awk '$1 < 11 { exit 1 }' ||
            { echo "$picture.svg: the name of an axis is cut"; return 1; }
    done
}

# shown TEXT...: the picture's SVG has these texts.
shown() {
    for text; do grep -qF -- "$text" "$picture.svg" || { echo "not in $picture.svg: $text"; return 1; }; done
}

@test "roofline: a point for each stage that sends, with its rate, under its roofs" {
    drawn roofline
    db=$BATS_FILE_TMPDIR/real.db
    n=$(sql "$db" "SELECT count(*) FROM roofline WHERE sent_bytes > 0 AND ordinal > 0")
    [ "$n" -ge 3 ]
    [ "$(tail -n +2 "$picture.csv" | wc -l)" -eq "$n" ]
    while read -r stage; do shown "$stage"; done < <(sql "$db" "SELECT stage FROM roofline WHERE sent_bytes > 0 AND ordinal > 0")
    shown 'Computing against communication of dynamics on t3e-300: n = 16; P = 16; level link' 'port and computing' \
        'message software' 'Mflop/s' 'flop/B'
    # no stage is above its roof
    sql_is "$db" 'SELECT count(*) FROM roofline WHERE attained > 1.000001 * min(ifnull(computing, 1e300), ifnull(bandwidth, 1e300), ifnull(software, 1e300))' 0
}

@test "slack: a point for each rank, critical or not, and the parts of the time" {
    drawn slack
    db=$BATS_FILE_TMPDIR/real.db
    [ "$(grep -c '^1,' "$picture.csv")" -eq 16 ]
    shown 'Slack of dynamics on t3e-300: n = 16; P = 16; level link' 'slack [µs]' 'rank' 'critical' 'nearly' 'more slack'
    # shares of a bar are the whole of it
    awk -F, '$1 == 2 && ($4 + $5 + $6 < 99.999 || $4 + $5 + $6 > 100.001) { bad = 1 } END { exit bad }' "$picture.csv"
    while read -r part; do shown "${part//&/&amp;}"; done < <(sql "$db" "SELECT stage || ': ' || cause FROM slack ORDER BY time_ps DESC LIMIT 3")
}

@test "load: latency over the load that was offered, with the saturation that was found" {
    drawn load
    db=$BATS_FILE_TMPDIR/real.db
    shown uniform
    [ "$(tail -n +2 "$picture.csv" | wc -l)" -eq "$(sql "$db" 'SELECT count(*) FROM load_point')" ]
    sql_is "$db" 'SELECT count(*) >= 3 FROM load_point' 1
}

@test "why, uncertainty, linkmap, pingpong and speedup" {
    for figure in why uncertainty linkmap pingpong speedup; do drawn $figure; done
    # its numbers are as long as 0.0625
    shown 'speedup S'
}

@test "every figure that made rows cannot draw is drawn here, or in tests of its own" {
    list=$(sed -n '/of_other_rows\[\] = {/,/};/p' "$MIMDSIM_SRCDIR/tests/report/test_figure.c" | grep -o '"[a-z]*"' | tr -d '"')
    [ "$(wc -w <<<"$list")" -ge 9 ]
    for figure in $list; do
        [[ " explain interference shares " == *" $figure "* ]] || grep -qE "(drawn|for figure in).*\b$figure\b" "$BATS_TEST_DIRNAME/figures.bats" ||
            { echo "nobody draws $figure"; return 1; }
    done
}

@test "a vertical axis stands right of its longest number, so that its name has room" {
    {
        echo "figure = 'x'"
        cat "$MIMDSIM_SRCDIR/plots/style.gp"
        echo 'set print "letters"; print letters_log(10, 0.0002, 3), letters_log(2, 0.07, 16), letters_log(10, 1, 1e5), letters_even(0, 5), letters_even(0, 0.05), letters_even(-3000, 12000)'
        echo 'set print "places"; do for [n=3:8] { print axis_px(n) }'
    } >letters.gp
    echo x >x.provenance
    works gnuplot -d letters.gp
    [ "$(cat letters)" = '6 6 6 3 5 6' ] || { cat letters; return 1; }
    # a letter takes nine pixels, beside 40 for the name and the tics
    awk -v n=3 '$1 < 40 + 9 * n { exit 1 } { n++ }' places
}

@test "a foot that is longer than the page goes on in further lines, none of them longer, and nothing is lost" {
    long='error of level not known, machine not known, arithmetic <= 8e-10; mimdsim 0.1.0 (5a20a0e3c74e), 41 runs, configurations'
    long="$long c08d40d609aa; t3e-300, paragon and 2 more; left out: 18 runs on t3e-300, topology.dims 16x8x8; 12 on t3e-300,"
    long="$long background.load 30 %, background.message 4 KiB and 3 more (28); drawn by d3d8ac9415ff"
    for text in "$long" 'mimdsim 0.1.0 (5a20a0e3c74e); drawn by d3d8ac9415ff' "${long// /_}"; do
        printf '%s\n' "$text" >x.provenance
        for wide in 640 800 1200; do
            {
                echo "figure = 'x'"
                cat "$MIMDSIM_SRCDIR/plots/style.gp"
                echo "set print 'foot'; print foot(provenance, $wide); set print 'lift'; print foot_lift(provenance, $wide)"
            } >foot.gp
            works gnuplot -d foot.gp
            [ "$(awk -v most=$((wide * 10 / 54)) 'length($0) > most' foot | wc -l)" -eq 0 ] || { cat foot; return 1; }
            [ "$(tr -d '\n' <foot)" = "$text" ]
            [ "$(cat lift)" -eq $((13 * ($(wc -l <foot) - 1))) ]
        done
    done
}

@test "a report has what was changed of a machine in words, and captions without lines for the program" {
    works mimdsim run speedup-t3e --set n=2,4 --set level=loggp --set machine=t3e-300,paragon -o two.db -q
    works mimdsim run speedup-t3e --set n=4 --set level=loggp --set machine.node.call='1 us' --set machine.network.hop_latency='2 us' \
        --name Slow -o two.db -q
    works mimdsim report two.db -q
    grep -F '>Slow</td>' two.html | grep -F 'node.call 1 us' | grep -qF 'network.hop_latency 2 us'
    run ! grep -F '{&quot;' two.html
    grep -q 'Figure 6 for several machines' two.md
    run ! grep -E '(shared|main|table): *(</|$)' two.md two.html
    # a link of the contents for each heading of the second level, and no two alike
    [ "$(grep -c '<h2 id=' two.html)" -gt 4 ]
    [ -z "$(grep -oE '<h2 id="[^"]*"' two.html | sort | uniq -d)" ]
}
