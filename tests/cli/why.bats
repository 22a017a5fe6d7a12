# why.bats - mimdsim why: the critical path of a run in words, rows and a figure.
load helper

@test "why tells the path by cause and stage, what parameters stand for, and what idealised machines gain" {
    works mimdsim why speedup-t3e --set n=16 --set level=loggp -o own.db --quiet
    stdout_says 'dynamics on t3e-300, n = 16, P = 16:'
    stdout_says 'is receive overhead, most of it in stage'
    stdout_says 'The critical path follows'
    stdout_says 'machine.software.recv.overhead'
    stdout_says 'zero overhead'
    stderr_is_empty
    # The path is the run: its parts add up to the makespan, to the picosecond.
    sql_is own.db 'SELECT (SELECT sum(time_ps) FROM critical_path) = makespan_ps FROM run' 1
    sql_is own.db 'SELECT count(*) FROM ideal' 6
    # Nothing idealised is slower, and what is paid 5 % more by the path alone lasts at least so long.
    sql_is own.db 'SELECT count(*) FROM ideal i JOIN run r ON r.id = i.run_id WHERE i.makespan_ps > r.makespan_ps AND i.machine <> '\''perfect balance'\''' 0
    sql_is own.db "SELECT count(*) FROM ideal WHERE machine = 'perfect balance' AND makespan_ps > 0" 1
    sql_is own.db "SELECT count(*) > 3 FROM sensitivity WHERE factor_5_percent > 1" 1
    # A second time nothing is doubled.
    works mimdsim why speedup-t3e --set n=16 --set level=loggp -o own.db --quiet
    sql_is own.db 'SELECT (SELECT sum(time_ps) FROM critical_path) = makespan_ps FROM run' 1
}

@test "why tells how much later the rest may be, where the path passes, and computing against communication" {
    works mimdsim why speedup-t3e --set n=16 --set level=link -o own.db --quiet
    stdout_says "Of the idealised machines 'zero overhead' helps most"
    stdout_says 'Before the run is 5 % longer, software'
    stdout_says 'Slack of the ranks'
    stdout_says 'Links and ports that the path passes'
    stdout_says 'Computing against communication'
    # Every rank is there; at least one is critical, and none has more than the run.
    sql_is own.db 'SELECT count(*) FROM rank_slack' 16
    sql_is own.db 'SELECT min(slack_ps) FROM rank_slack' 0
    sql_is own.db 'SELECT count(*) FROM rank_slack s JOIN run r ON r.id = s.run_id WHERE slack_ps > makespan_ps' 0
    # What is critical is at least the path, and computing of the table is that of the run.
    sql_is own.db "SELECT sum(critical_ps) >= (SELECT makespan_ps FROM run) FROM slack" 1
    sql_is own.db "SELECT sum(time_ps) = (SELECT sum(compute_sum_ps) FROM stage) FROM slack WHERE cause = 'computing'" 1
    sql_is own.db 'SELECT count(*) FROM slack WHERE critical_ps > near_ps OR near_ps > time_ps' 0
    sql_is own.db 'SELECT count(*) FROM roofline WHERE attained > computing * 1.000001' 0
    sql_is own.db "SELECT flops = (SELECT sum(flops) FROM stage) FROM roofline WHERE ordinal = 0" 1
    sql_is own.db 'SELECT count(*) > 0 FROM path_resource' 1
    works mimdsim why speedup-t3e --set n=16 --set level=link -o own.db --json
    [ "$(sqlite3 :memory: "SELECT json_array_length('$output', '\$.rank_slack_ps'), json_array_length('$output', '\$.roofline') > 3")" = "16|1" ]
    # A second time nothing is doubled, and --brief says nothing of it.
    sql_is own.db 'SELECT count(*) FROM rank_slack' 16
    works mimdsim why own.db 1 --brief
    ! grep -q 'Slack' <<<"$output"
}

@test "why, explain and the report say how far times are known, and what is not known" {
    works mimdsim explain speedup-t3e --set n=4
    stdout_says 'How sure: not known before the runs are made'
    works mimdsim why speedup-t3e --set n=4 --set level=loggp --quiet
    stdout_says 'How sure: the network level is not known to be right'
    stdout_says 'not known (mimdsim run --uncertainty 64 tells)'
    stdout_says 'the arithmetic is within'
    works mimdsim run speedup-t3e --set n=4 --set level=loggp --uncertainty 8 --quiet
    works mimdsim why mimdsim.db 1 --brief
    grep -Eq 'leave open is [+-][0-9]+ to [+][0-9]+ %' <<<"$output"
    works mimdsim explain speedup-t3e --set n=4 --set level=loggp
    grep -Eq 'leave open is [+-][0-9]+ to [+][0-9]+ %' <<<"$output"
    works mimdsim why mimdsim.db 1 --json
    [[ "$(sqlite3 :memory: "SELECT json_extract('$output', '\$.how_sure')")" == 'How sure:'* ]]
    command -v gnuplot >/dev/null || skip "gnuplot is not installed"
    works mimdsim report mimdsim.db
    grep -q 'How sure: the network level' mimdsim.md
    # A file that is no database says nothing, and explaining goes on.
    echo text >no.db
    works mimdsim explain speedup-t3e --set n=4 -o no.db
    stdout_says 'How sure: not known'
}

@test "why calls a run what it is called" {
    works mimdsim why speedup-t3e --set n=8 --set machine.network.hop_latency="60 us" -o own.db --quiet
    stdout_says 'dynamics on t3e-300, hop_latency 60 us, n = 8'
    works mimdsim run speedup-t3e --set n=8 --name 'my machine' -o named.db --quiet
    works mimdsim why named.db 1 --brief
    stdout_says 'dynamics on my machine, n = 8'
}

@test "the factor that makes a run 5 % longer does so" {
    works mimdsim why speedup-t3e --set n=16 -o own.db --quiet
    factor=$(sql own.db "SELECT factor_5_percent FROM sensitivity WHERE key = 'machine.software.recv.overhead'")
    overhead=$(sql own.db "SELECT value FROM setting WHERE key = 'machine.software.recv.overhead'")
    # "7 us" times the factor
    longer=$(awk -v o="${overhead% *}" -v f="$factor" 'BEGIN { printf "%.9g", o * f }')
    works mimdsim run speedup-t3e --set n=16 --set machine.software.recv.overhead="$longer ${overhead#* }" -o own.db --quiet
    sql_is own.db "SELECT abs(1.0 * max(makespan_ps) / min(makespan_ps) - 1.05) < 0.0005 FROM run" 1
}

@test "a stored run is explained as it was made, and answers are one JSON document" {
    works mimdsim run speedup-t3e --set n=8,16 -o own.db --quiet
    works mimdsim why own.db 2 --json
    [ "$(sqlite3 :memory: "SELECT json_extract('$output', '\$.makespan_ps')")" = "$(sql own.db 'SELECT makespan_ps FROM run WHERE id = 2')" ]
    works mimdsim why own.db 1 --brief
    stdout_says 'n = 8'
    ! grep -q 'zero latency' <<<"$output"
    sql_is own.db 'SELECT count(*) FROM critical_path' 0
}

@test "the figure of a run draws its path" {
    command -v gnuplot >/dev/null || skip "gnuplot is not installed"
    works mimdsim why speedup-t3e --set n=16 -o own.db --quiet
    works mimdsim plot own.db why
    [ -s figures/why-1.png ] && [ -s figures/why-1.svg ]
    grep -q 'receive overhead' figures/why-1.csv
    grep -q 'perfect balance' figures/why-1.csv
    works mimdsim plot own.db slack
    works mimdsim plot own.db roofline
    [ -s figures/slack-1.png ] && [ -s figures/roofline-1.svg ]
    grep -q 'NE\[1\]' figures/roofline-1.csv
}

@test "what cannot be explained is refused, and nothing is left behind" {
    fails_with 66 mimdsim why nowhere
    fails_with 64 mimdsim why
    fails_with 65 mimdsim why speedup-t3e --set n=sixteen
    fails_with 78 mimdsim why speedup-t3e --set level=packet --set machine.network.buffer=1
    fails_with 70 mimdsim why deadlock --quiet
    stderr_says 'wait'
    nothing_left_behind
    works mimdsim run speedup-t3e --set n=8 -o own.db --quiet
    fails_with 64 mimdsim why own.db
    fails_with 66 mimdsim why own.db 99
    stderr_says 'there is no run 99'
    fails_with 64 mimdsim why own.db one
    sqlite3 own.db "UPDATE run SET config_text = 'nothing = 1'"
    fails_with 65 mimdsim why own.db 1
}

@test "a program of one's own is explained, and infinitely fast nodes take its computing away" {
    command -v gcc >/dev/null || skip "gcc is not installed"
    works mimdsim why "$MIMDSIM_SRCDIR/examples/stencil.yaml" --set ranks=4 --set n=64 -o own.db --quiet
    stdout_says 'stencil on t3e-300, n = 64, P = 4'
    sql_is own.db 'SELECT (SELECT sum(time_ps) FROM critical_path) = makespan_ps FROM run' 1
    sql_is own.db "SELECT i.makespan_ps < r.makespan_ps - (SELECT sum(time_ps) FROM critical_path WHERE cause = 'computing') / 2
        FROM ideal i, run r WHERE i.machine LIKE 'infinitely fast%'" 1
    sql_is own.db 'SELECT count(makespan_ps) FROM ideal' 6
}

@test "explain tells before what recording the path will need" {
    works mimdsim explain speedup-t3e --set n=128 --set level=link
    stdout_says 'to record the critical path (mimdsim why): about 3.9 MB more'
    works mimdsim explain speedup-t3e --set n=128 --set level=loggp
    stdout_says 'to record the critical path (mimdsim why): about 2.7 MB more'
    # one rank sends nothing
    works mimdsim explain four-bar --set ranks=1
    [[ $output != *'to record'* ]]
}
