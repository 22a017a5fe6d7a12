#!/usr/bin/env bats
# compare.bats - machines, databases and runs side by side: settings, ratios, where the time goes.

load helper

@test "two machines: what differs, times with ratios, where the time goes, a figure" {
    works mimdsim compare t3e-300 paragon --set n=8,16 --set level=loggp -o c.db
    stdout_says 'A  t3e-300: 2 runs'
    stdout_says 'machine.network.link.bandwidth       480 MB/s                       175 MB/s'
    stdout_says 'Where the time goes at n 16'
    stdout_says figures/compare-t3e-300-paragon.png
    [ -s figures/compare-t3e-300-paragon.svg ]
    # the ratio is that of the stored times, and is their geometric mean in the first sentence
    ratio=$(sql c.db "SELECT printf('%.4g', exp(avg(ln(1.0 * p.makespan_ps / t.makespan_ps)))) FROM run p JOIN run t USING (n)
        WHERE p.machine = 'paragon' AND t.machine = 't3e-300'")
    stdout_says "B takes $ratio times as long as A (geometric mean of 2 points"
    # nothing is run twice
    works mimdsim compare t3e-300 paragon --set n=8,16 --set level=loggp -o c.db --quiet
    sql_is c.db 'SELECT count(*) FROM run' 4
}

@test "names, runs and databases are sides as well, and only common points are compared" {
    works mimdsim run speedup-t3e --set n=8,16 --set level=loggp -o c.db --quiet
    works mimdsim run speedup-t3e --set n=16,32 --set level=loggp --set machine.node.call='5 us' --name 'slow, calls' -o c.db --quiet
    works mimdsim compare t3e-300 'slow, calls' --set n=8,16 --set level=loggp -o c.db
    stdout_says 'machine.node.call                    50 ns                          5 us'
    stdout_says 'Left out: 2 points that not all sides have.'
    [ "$(printf '%s\n' "$output" | grep -c '^machine\.')" = 1 ]
    works mimdsim compare 2 3 -o c.db --json
    json_is_valid
    json_is '$.differences[0].key' machine.node.call
    json_is '$.points[0].sides[0].ratio' 1
    works mimdsim run speedup-t3e --set n=16 --set level=loggp -o d.db --quiet
    works mimdsim compare c.db d.db
    stdout_says 'B takes 1 times as long as A'
    # one is not several
    works mimdsim run speedup-t3e --set n=8,16 --set level=loggp -o e.db --quiet
    works mimdsim compare d.db e.db
    stdout_says 'Left out: 1 point that not all sides have.'
}

@test "the foot of the figure says how far the times of all sides are known, also of two databases" {
    for db in one two; do
        works mimdsim run speedup-t3e --set n=8,16 --set level=loggp -o $db.db --quiet
    done
    works mimdsim compare one.db two.db --quiet
    grep -q 'error of level' figures/compare-*.svg
    # what only one of them knows is told with the number of its runs
    works mimdsim run speedup-t3e --set n=8,16 --set level=loggp --uncertainty 4 -o two.db --quiet
    works mimdsim compare one.db two.db --quiet
    tr '\n' ' ' <"$(ls -t figures/compare-*.svg | head -1)" | grep -q 'machine [-+][0-9]*[.][.][-+][0-9]* % (2 of 4 runs)'
}

@test "a rate without a limit is called unlimited, never 0" {
    printf '%s\n' 'schema_version: 1' 'base: t3e-300' 'network: {link: {bandwidth: unlimited}}' 'title: no limit' >free.yaml
    works mimdsim compare t3e-300 free.yaml --set n=8,16 --set level=loggp -o c.db --quiet
    stdout_says 'machine.network.link.bandwidth       480 MB/s                       unlimited'
    # a rate that a file does not state is that of a link
    printf '%s\n' 'schema_version: 1' 'base: t3e-300' 'network: {injection: {bandwidth: 0 B/s}}' >own.yaml
    [[ $output != *' 0 B/s'* ]] || { show; return 1; }
    works mimdsim compare t3e-300 own.yaml --set n=8 --set level=loggp -o own.db --quiet
    stdout_says 'machine.network.injection.bandwidth  340 MB/s                       as a link'
    works mimdsim compare t3e-300 free.yaml --set n=8,16 --set level=loggp -o c.db --json
    json_is '$.differences[#-1].values[1]' unlimited
    sql_is c.db "SELECT count(*) FROM v_setting WHERE key = 'machine.network.link.bandwidth' AND value = 'unlimited' AND number IS NULL" 2
    sql_is c.db "SELECT count(*) FROM v_itervar WHERE key = 'machine.network.link.bandwidth' AND value = 'unlimited'" 2
    # every setting whose 0 has a word of its own is one of these
    sql_is c.db "SELECT count(*) FROM v_unlimited WHERE key IN ('machine.network.link.bandwidth', 'machine.node.copy.bandwidth')" 2
}

@test "a database of several machines says why none of its runs has a partner on a third" {
    for machine in t3e-300 paragon cm-5; do
        case $machine in cm-5) db=one.db ;; *) db=two.db ;; esac
        works mimdsim run speedup-t3e -m $machine --set n=8 --set level=loggp -o $db --quiet
    done
    fails_with 66 mimdsim compare two.db one.db
    stderr_says "'two.db' has runs on several machines, so only runs on machines of the same name are compared"
    stderr_says 'single runs are compared by their numbers: mimdsim compare 1 2 -o DB'
}

@test "repeated runs have ratios with an interval" {
    for db in a b; do
        [ $db = a ] && cv='10 %' || cv='20 %'
        works mimdsim run speedup-t3e --set n=16 --set level=loggp --set repetitions=4 --set machine.noise.compute="$cv" -o $db.db --quiet
    done
    works mimdsim compare a.db b.db
    stdout_says ' +- '
    stdout_says 'half of the 95 % confidence interval'
    stdout_says 'machine.noise.compute'
}

@test "what is no side is told with the nearest name" {
    fails_with 66 mimdsim compare t3e-300 paragn --set n=4 --set level=loggp -o c.db
    stderr_says "did you mean 'paragon'?"
    [ ! -e c.db ] # nothing was run before both sides were found
    works mimdsim run speedup-t3e --set n=4 --set level=loggp -o c.db --quiet
    fails_with 66 mimdsim compare 1 99 -o c.db
    stderr_says "'run 99' has no run that ended well"
    fails_with 64 mimdsim compare t3e-300
    works mimdsim run speedup-t3e --set n=4,8 --set level=loggp -o x.db --quiet
    works mimdsim run speedup-t3e --set n=16,32 --set level=loggp -o y.db --quiet
    fails_with 66 mimdsim compare x.db y.db
    stderr_says 'nothing can be compared point by point'
    MIMDSIM_GNUPLOT=/no/gnuplot fails_with 69 mimdsim compare t3e-300 paragon --set n=4 --set level=loggp -o c.db
    stdout_says 'B takes '
}

@test "each side says how far its times are known" {
    works mimdsim compare t3e-300 paragon --set n=4 --set level=loggp
    stdout_says 'A  How sure: the network level is not known to be right'
    stdout_says 'B  How sure:'
    works mimdsim run speedup-t3e --set n=4 --set level=loggp --uncertainty 8 --quiet
    works mimdsim compare t3e-300 paragon --set n=4 --set level=loggp
    grep -Eq '^A  How sure: .* leave open is [+-][0-9]+ to' <<<"$output"
    works mimdsim compare t3e-300 paragon --set n=4 --set level=loggp --json
    ! grep -q 'How sure' <<<"$output"
}

@test "all sides are found before anything is run or stored" {
    fails_with 66 mimdsim compare t3e-300 nowhere --set n=4
    stderr_says "'nowhere' is no machine"
    nothing_left_behind
    fails_with 66 mimdsim compare t3e-300 /dev/null --set n=4
    nothing_left_behind
    fails_with 66 mimdsim compare speedup-t3e 17 --set n=4
    nothing_left_behind
    printf 'schema_version: 1\nbase: t3e-300\nnetwork: {hop_latency: 3}\n' >bad.yaml
    fails_with 65 mimdsim compare t3e-300 bad.yaml --set n=4
    [ ! -e mimdsim.db ]
    # A run that is stored and a machine whose runs are made go together, in either order.
    works mimdsim run speedup-t3e --set n=4 --set level=loggp --quiet
    works mimdsim compare 1 paragon --set n=4 --set level=loggp
    stdout_says 'run 1'
    works mimdsim compare paragon 1 --set n=4 --set level=loggp
    sql_is mimdsim.db 'SELECT count(*) FROM run' 2
}
