#!/usr/bin/env bats
# jobs.bats - several jobs on one machine: rows of their own, what they do to each other, and what is refused.

load helper

# scenario LINE...: jobs on a torus of 4 x 4 x 2 T3E processors at level link, with these lines besides, as s.yaml.
scenario() {
    printf '%s\n' 'schema_version: 1' 'question: what?' 'machine: t3e-300' 'machine.topology.dims: [4, 4, 2]' \
        'level: link' "$@" >s.yaml
}

# Two jobs of 8 ranks that send much, where nothing else is said.
two=('jobs:' '  - {name: solver, kernel: forward, n: 16, ranks: 8}'
     '  - {name: swap, kernel: {name: all-to-all, message: 8 KiB}, ranks: 8}')

@test "one job has the makespan and the digest of the same scenario without jobs, at every level" {
    scenario 'kernel: dynamics' 'n: 16' 'ranks: 8' 'machine.noise.compute: 5 %' 'sweep: {level: [loggp, packet, flit, auto]}'
    sed -i '/^level/d' s.yaml
    works mimdsim run s.yaml -o s.db --quiet
    cp s.yaml j.yaml
    sed -i '/^kernel\|^n:\|^ranks/d' j.yaml
    printf '%s\n' 'jobs: [{name: only, kernel: dynamics, n: 16, ranks: 8}]' >>j.yaml
    works mimdsim run j.yaml -o s.db --quiet
    works mimdsim run s.yaml --set level=link -o s.db --quiet
    works mimdsim run j.yaml --set level=link -o s.db --quiet
    sql_is s.db "SELECT count(*) FROM run a JOIN run b ON a.level = b.level AND a.scenario = 's' AND b.scenario = 'j'
                 AND a.makespan_ps = b.makespan_ps AND a.digest = b.digest" 5
    sql_is s.db "SELECT count(*) FROM run" 10
}

@test "each job has rows of its own: stages, ranks, checks, serial codes" {
    scenario "${two[@]}"
    works mimdsim run s.yaml -o s.db --columns job,beside,kernel,n,P,status
    stdout_says 'solver  swap    forward'
    stdout_says 'swap    solver  all-to-all'
    sql_is s.db "SELECT status || P || kernel FROM run ORDER BY id" 'ok8forward
ok8all-to-all'
    # its own program's, each of them complete
    sql_is s.db "SELECT count(*) FROM stage WHERE run_id = 2" 2
    [ "$(sql s.db "SELECT count(*) FROM stage WHERE run_id = 1")" -gt 4 ]
    [ "$(sql s.db "SELECT count(*) FROM error_check WHERE run_id = 1")" -ge 1 ]
    [ "$(sql s.db "SELECT count(*) FROM baseline WHERE run_id = 1")" -ge 2 ]
    sql_is s.db "SELECT count(*) FROM v_label WHERE name LIKE 'solver beside swap, %'" 1
    # every rank's stages add up to its job's makespan
    sql_is s.db "SELECT count(*) FROM (SELECT s.run_id FROM rank_stage s JOIN run r ON r.id = s.run_id GROUP BY s.run_id, s.rank
                 HAVING sum(compute_ps + send_ps + recv_ps + wait_ps + contention_ps) <> max(r.makespan_ps))" 0
    works mimdsim check s.db --again 2
    # stored runs are found again
    works mimdsim run s.yaml -o s.db --quiet
    sql_is s.db "SELECT count(*) FROM run" 2
}

@test "combinations: alone, in pairs, all; two of them say what one says only once" {
    scenario "${two[@]}" '  - {name: third, kernel: barrier, ranks: 4}' 'combinations: [all, alone, pairs]'
    works mimdsim plan s.yaml --json
    json_is '$[#-1].P' 4
    works mimdsim run s.yaml -o s.db --quiet
    sql_is s.db "SELECT group_concat(value, '/') FROM (SELECT value FROM v_setting WHERE key = 'job.beside' AND run_id IN
                 (SELECT run_id FROM v_setting WHERE key = 'job.name' AND value = 'swap') ORDER BY run_id)" \
        '/solver/third/solver + third'
    sql_is s.db "SELECT count(*), count(DISTINCT value) FROM v_setting WHERE key = 'job.set'" '12|1'
    works mimdsim run s.yaml --set combinations=pairs -o p.db --quiet
    sql_is p.db "SELECT count(*) FROM run" 6
    scenario "${two[@]}" 'combinations: [pairs, all, alone]'
    works mimdsim run s.yaml -o t.db --quiet
    sql_is t.db "SELECT count(*) FROM run" 4
}

@test "jobs in parts of their own do not disturb each other, scattered ones do" {
    scenario "${two[@]}" 'combinations: [alone, all]' 'sweep: {machine.placement.kind: [groups, random]}'
    works mimdsim run s.yaml -o s.db --quiet
    times="SELECT count(DISTINCT makespan_ps) FROM run r JOIN v_setting j ON j.run_id = r.id AND j.key = 'job.name'"
    sql_is s.db "$times AND j.value = 'solver' WHERE r.placement = 'groups'" 1
    sql_is s.db "$times AND j.value = 'swap' WHERE r.placement = 'groups'" 1
    sql_is s.db "$times AND j.value = 'solver' WHERE r.placement = 'random'" 2
}

@test "each job has its start, its place and its seed; workers change nothing" {
    printf '%s\n' '# two rows' '0-3, 8-11' >places.txt
    scenario 'jobs:' '  - {name: a, kernel: {name: random-ring, message: 64 KiB}, ranks: 8, placement: {file: places.txt}, seed: 3}' \
        '  - {name: b, kernel: {name: random-ring, message: 64 KiB}, ranks: 8, placement: random, start: 50 us}' \
        '  - {name: c, kernel: {name: ring, message: 64 KiB}, ranks: 4, placement: [31, 30, 29, 28]}' \
        '  - {name: d, kernel: {name: ring, message: 64 KiB}, ranks: 4, placement: {kind: random, seed: 9}}' \
        'combinations: [alone, pairs, all]' 'record: {links: true}'
    works mimdsim run s.yaml -o one.db --quiet --jobs 1
    works mimdsim run s.yaml -o four.db --quiet --jobs 4
    key="SELECT group_concat(digest || makespan_ps || seed) FROM (SELECT * FROM run ORDER BY id)"
    [ "$(sql one.db "$key")" = "$(sql four.db "$key")" ]
    sql_is one.db "SELECT DISTINCT s.value FROM v_setting s JOIN v_setting n USING (run_id) WHERE s.key = 'machine.placement.list'
                   AND n.key = 'job.name' AND n.value = 'a'" '[0, 1, 2, 3, 8, 9, 10, 11]'
    sql_is one.db "SELECT DISTINCT s.value FROM v_setting s JOIN v_setting n USING (run_id) WHERE s.key = 'job.start' AND n.key = 'job.name' AND n.value = 'b'" '50 us'
    # what a job sends over a link is the same beside others: deterministic routes
    sql_is one.db "SELECT count(*) FROM (SELECT l.link, l.node, n.value AS job FROM link_load l JOIN v_setting n ON n.run_id = l.run_id AND n.key = 'job.name'
                   GROUP BY 1, 3 HAVING count(DISTINCT l.messages || '/' || l.sent_bytes) > 1)" 0
    works mimdsim check one.db --again 6
}

@test "links: of jobs that ran together, each one's share of every link" {
    scenario "${two[@]}" '  - {name: third, kernel: barrier, ranks: 4}' 'combinations: [alone, pairs, all]' 'record: {links: true}'
    works mimdsim run s.yaml -o s.db --quiet --set jobs.solver.placement=random --set jobs.swap.placement=random
    beside() { sql s.db "SELECT n.run_id FROM v_setting n JOIN v_setting b USING (run_id) WHERE n.key = 'job.name' AND n.value = 'solver'
                         AND b.key = 'job.beside' AND b.value = '$1'"; }
    works mimdsim links s.db "$(beside swap)" --json
    printf '%s' "$output" >l.json
    # a link's shares make all of it; some links have both jobs, none the third
    sql_is s.db "SELECT count(*) FROM (SELECT 1 FROM json_each(readfile('l.json')) GROUP BY value ->> 'link'
                 HAVING abs(sum(value ->> 'share_percent') - 100) > 0.11)" 0
    sql_is s.db "SELECT count(*) > 0 FROM (SELECT 1 FROM json_each(readfile('l.json')) GROUP BY value ->> 'link' HAVING count(*) = 2)" 1
    sql_is s.db "SELECT group_concat(DISTINCT value ->> 'job'), count(DISTINCT value ->> 'run_id') FROM json_each(readfile('l.json'))" 'solver,swap|2'
    # each row is what its own run recorded
    sql_is s.db "SELECT count(*) = (SELECT count(*) FROM json_each(readfile('l.json'))) FROM json_each(readfile('l.json')) j JOIN link_load l
                 ON l.run_id = j.value ->> 'run_id' AND l.link = j.value ->> 'link' AND l.messages = j.value ->> 'messages'
                 AND abs(l.busy_ps / 1e6 - (j.value ->> 'busy_us')) < 1e-9" 1
    works mimdsim links s.db "$(beside 'swap + third')"
    stdout_says 'share_percent'
    works mimdsim links s.db "$(beside '')"
    [[ $output != *share_percent* ]]
}

@test "--set reaches one job, all jobs, and the sweep over what they share" {
    scenario "${two[@]}"
    works mimdsim run s.yaml -o s.db --quiet --set jobs.swap.kernel.message='1 KiB' --set jobs.swap.start='2 ms' \
        --set jobs.solver.placement=random --set jobs.swap.placement='[4, 5, 6, 7, 12, 13, 14, 15]' --set seed=5
    sql_is s.db "SELECT DISTINCT value FROM v_setting WHERE key = 'jobs.2.kernel.message' OR (key = 'kernel.message' AND run_id = 2)" '1 KiB'
    sql_is s.db "SELECT placement FROM run ORDER BY id" 'random
list'
    sql_is s.db "SELECT DISTINCT seed FROM run" 5
    works mimdsim run s.yaml -o t.db --quiet --set level=loggp,packet
    sql_is t.db "SELECT count(*), count(DISTINCT level) FROM run" '4|2'
    fails_with 65 mimdsim run s.yaml -o none.db --set jobs.swop.ranks=4
    stderr_says "no job is called 'swop'; did you mean 'swap'?; keys are jobs.NAME.KEY"
    fails_with 65 mimdsim run s.yaml -o none.db --set jobs.swap.rank=4
    stderr_says "did you mean 'ranks'?"
    fails_with 65 mimdsim run s.yaml -o none.db --set jobs.swap.name=x
    stderr_says 'a job keeps its name'
    fails_with 65 mimdsim run s.yaml -o none.db --set job.number=2
    stderr_says "unknown key 'job.number'"
}

@test "programs of one's own run beside others, each with its parameters" {
    works mimdsim new heat
    scenario 'jobs:' '  - {name: first, program: heat.c, ranks: 8}' '  - {name: second, program: heat.c, ranks: 4, placement: random}' \
        '  - {name: third, kernel: {name: all-to-all, message: 4 KiB}, ranks: 8}' 'combinations: [alone, all]'
    works mimdsim run s.yaml -o s.db --quiet
    sql_is s.db "SELECT group_concat(status, '') FROM run" okokokokokok
    [ "$(sql s.db "SELECT count(*) FROM error_check")" -ge 4 ]
}

@test "a job that fails is named by those beside it" {
    cat >stuck.c <<'C'
#include <mimdsim/program.h>
static void run(struct comm *c)
{
    char byte[1];
    if (comm_rank(c) == 0) comm_recv(c, 1, 7, byte, 1);
}
PROGRAM(.title = "waits for ever", .run = run);
C
    scenario 'jobs:' '  - {name: good, kernel: barrier, ranks: 4}' '  - {name: bad, program: stuck.c, ranks: 2}'
    run --separate-stderr mimdsim run s.yaml -o s.db --quiet
    [ "$status" -ne 0 ]
    sql_is s.db "SELECT status FROM run ORDER BY id" 'failed
deadlock'
    sql_is s.db "SELECT text LIKE 'job ''bad'' beside it: deadlock: rank 0%' FROM run WHERE id = 1" 1
}

# refused TEXT LINE...: the scenario with these lines has status 65 or 78 and is told so, and nothing is left behind.
refused() {
    local text=$1
    shift
    scenario "$@"
    run --separate-stderr -- mimdsim run s.yaml -o none.db
    [ "$status" -eq 65 ] || [ "$status" -eq 66 ] || [ "$status" -eq 78 ] || { show; return 1; }
    stderr_says "$text"
    rm s.yaml
    nothing_left_behind
}

@test "jobs that make no sense are refused with their place" {
    refused "s.yaml:6: jobs: expected a list of jobs such as" 'jobs: {name: a}'
    refused "s.yaml:6: jobs: expected a list of jobs such as" 'jobs: []'
    refused "s.yaml:6: jobs: expected a mapping such as" 'jobs: [forward]'
    refused "s.yaml:6: jobs: a job without a name" 'jobs: [{kernel: barrier, ranks: 4}]'
    refused "s.yaml:6: jobs: name: 'a b': expected a letter" 'jobs: [{name: a b, kernel: barrier, ranks: 4}]'
    refused "s.yaml:8: jobs: two jobs are called 'a'; the first in line 7" 'jobs:' '  - {name: a, kernel: barrier, ranks: 4}' '  - {name: a, kernel: barrier, ranks: 4}'
    refused "s.yaml:6: no kernel is called 'forwrd'; did you mean 'forward'?" 'jobs: [{name: a, kernel: forwrd, n: 8, ranks: 4}]'
    refused "program 'nothing.c': there is no such file" 'jobs: [{name: a, program: nothing.c, ranks: 4}]'
    refused "s.yaml:6: job 'a': start: '-1 ms'" 'jobs: [{name: a, kernel: barrier, ranks: 4, start: -1 ms}]'
    refused "s.yaml:6: job 'a': start: '3': " 'jobs: [{name: a, kernel: barrier, ranks: 4, start: 3}]'
    refused "s.yaml:6: unknown key 'strat'; did you mean 'start'?" 'jobs: [{name: a, kernel: barrier, ranks: 4, strat: 1 s}]'
    refused "ranks: '0'" 'jobs: [{name: a, kernel: barrier, ranks: 0}]'
    refused "ranks: '99999999999'" 'jobs: [{name: a, kernel: barrier, ranks: 99999999999}]'
    refused "ranks is missing" 'jobs: [{name: a, kernel: barrier}]'
    refused "s.yaml:8: job 'b' has 20 ranks, but the jobs before it leave 12 of the 32 processors of machine 't3e-300'" \
        'jobs:' '  - {name: a, kernel: barrier, ranks: 20}' '  - {name: b, kernel: barrier, ranks: 20}'
    refused "job 'a': 'machine.network.level' belongs to the machine, which all jobs share" 'jobs: [{name: a, kernel: barrier, ranks: 4, level: flit}]'
    refused "'ranks' is swept here and set by job 'a' in line 6" 'jobs: [{name: a, kernel: barrier, ranks: 4}]' 'sweep: {ranks: [2, 4]}'
    refused "'optimise' and 'jobs' (line 6) exclude each other" 'jobs: [{name: a, kernel: barrier, ranks: 4}]' \
        'optimise: {least: makespan_s, over: {machine.placement.kind: [linear, random]}}'
    {
        echo 'jobs:'
        for i in $(seq 65); do echo "  - {name: j$i, kernel: barrier, ranks: 1}"; done
    } >many
    refused "s.yaml:6: jobs: 65 jobs; expected at most 64" "$(cat many; rm many)"
}

@test "places that make no sense are refused with their job" {
    two_on() { printf '%s\n' 'jobs:' "  - {name: a, kernel: barrier, ranks: 4, placement: $1}" "  - {name: b, kernel: barrier, ranks: 3, placement: $2}"; }
    refused "s.yaml:8: jobs 'a' and 'b' overlap: rank 2 of one and rank 1 of the other on processor 2" "$(two_on '[0, 1, 2, 3]' '[9, 2, 10]')"
    refused "placement: 'everywhere': expected contiguous, random, groups, snake, gray, a list of processors or {file: NAME}" "$(two_on everywhere random)"
    refused "placement: 'randm': did you mean 'random'?" "$(two_on randm random)"
    refused "job 'a': seed: 'a list or mapping': expected one value" "$(two_on '{kind: random, seed: [3]}' random)"
    refused "placement: unknown key 'fil'; did you mean 'file'?" "$(two_on '{fil: x}' random)"
    refused "job 'b' has 3 ranks, but its list names 2 processors" "$(two_on contiguous '[1, 2]')"
    refused "processor 32 of rank 0; expected 0 to 31" "$(two_on contiguous '[32, 1, 2]')"
    refused "nowhere.txt: cannot open" "$(two_on '{file: nowhere.txt}' random)"
    printf '%s\n' '0 1' '7-5' >wrong.txt
    scenario "$(two_on '{file: wrong.txt}' random)"
    fails_with 65 mimdsim check s.yaml
    stderr_says "wrong.txt:2: '7-5': expected numbers of processors, such as 0 1 2 or 4-7"
    # 9 bytes of a file for 10 MB of a list are the most, also in two files
    echo 0-599999 >many.txt
    scenario "$(two_on '{file: many.txt}' '{file: many.txt}')"
    fails_with 65 mimdsim check s.yaml
    stderr_says "many.txt:1: '0-599999': the files of all jobs name more than 1048576 processors"
    echo 0-99999999999999999999 >many.txt
    fails_with 65 mimdsim check s.yaml
    stderr_says "many.txt:1: '0-99999999999999999999': expected numbers of processors"
    scenario "$(two_on gray random)"
    fails_with 78 mimdsim run s.yaml -o none.db
    stderr_says 'placement.kind gray needs a hypercube'
}

@test "combinations without jobs, and words that are none" {
    refused "combinations: the scenario has no 'jobs' to combine" 'kernel: barrier' 'ranks: 4' 'combinations: all'
    refused "combinations: 'pair': did you mean 'pairs'?" "${two[@]}" 'combinations: pair'
    refused "combinations: 'each': expected all, alone, pairs or a list of them" "${two[@]}" 'combinations: [each]'
}

@test "interference: the matrix, its figure, and the error of background traffic in place of neighbours" {
    scenario 'jobs:' '  - {name: solver, kernel: forward, n: 32, ranks: 8}' '  - {name: swap, kernel: {name: all-to-all, message: 16 KiB}, ranks: 8}' \
        '  - {name: ring, kernel: {name: random-ring, message: 64 KiB}, ranks: 8}' 'sweep: {machine.placement.kind: [groups, random]}'
    works mimdsim interference s.yaml -o s.db --json
    json_is_valid
    # alone 3, pairs 6, all 3, background 2 jobs five times and one that draws itself: at two places
    sql_is s.db "SELECT count(*), sum(status = 'ok') FROM run" '46|46'
    # each cell by its definition
    json_is '$[#-1].beside' background
    sql s.db "SELECT round(1.0 * b.makespan_ps / a.makespan_ps, 4) FROM run a JOIN run b ON b.label LIKE 'solver beside ring, %' AND b.placement = 'random'
              WHERE a.label LIKE 'solver alone, %' AND a.placement = 'random' AND ifnull(a.background_load, 0) = 0" >cell
    sqlite3 :memory: "SELECT value ->> 'slowdown' FROM json_each('$output') WHERE value ->> 'job' = 'solver' AND value ->> 'beside' = 'ring'
                      AND value ->> 'placement' = 'random'" >told
    diff cell told
    # groups are undisturbed: 1 beside each; the background does not know that
    sqlite3 :memory: "SELECT count(*), sum(value ->> 'slowdown' = 1) FROM json_each('$output') WHERE value ->> 'placement' = 'groups'
                      AND value ->> 'beside' <> 'background'" >told
    [ "$(cat told)" = '9|9' ]
    sqlite3 :memory: "SELECT count(*) FROM json_each('$output') WHERE value ->> 'beside' = 'background' AND value ->> 'background_percent' > 0
                      AND value ->> 'error_percent' IS NOT NULL" >told
    [ "$(cat told)" = 6 ]
    [ -s figures/interference.png ] && [ -s figures/interference.svg ]
    # loads stand in names, with no more digits than people read
    grep -q 'background.load [0-9.]* %' figures/interference.provenance
    run ! grep -qE '[0-9][.][0-9]{4}' figures/interference.provenance
    [ "$(tail -n +2 figures/interference.csv | wc -l)" -eq 24 ]
    # which job loads which link: all of a link's busy time, and never two jobs on one where each has its own part
    works mimdsim plot s.db shares
    sqlite3 :memory: '.import --csv figures/shares.csv s' "SELECT count(*) > 0, total(abs(whole - 1) > 1e-9 OR abs(top - busy) > 1e-9), sum(jobs > 1)
        FROM (SELECT sum(of_link) AS whole, max(below + share) AS top, sum(share) AS busy, count(*) AS jobs FROM s GROUP BY panel, link)" >told
    [[ $(cat told) == 1'|0.0|'[1-9]* ]]
    sqlite3 :memory: '.import --csv figures/shares.csv s' "SELECT sum(n > 1) FROM (SELECT count(*) AS n FROM s WHERE panel_name LIKE '%groups' GROUP BY link)" >told
    [ "$(cat told)" = 0 ]
    # the bars are named in their own panel
    sqlite3 :memory: '.import --csv figures/shares.csv s' "SELECT DISTINCT name FROM s" | while read -r name; do
        grep -qF "$name" figures/shares.svg || { echo "no $name"; exit 1; }
    done
    # nothing is run twice, and other seeds of the same rows agree
    works mimdsim interference s.yaml -o s.db --quiet
    sql_is s.db "SELECT count(*) FROM run" 46
    works mimdsim plot s.db interference
    works mimdsim check s.db --again 6
}

@test "interference takes scenarios with jobs" {
    fails_with 65 mimdsim interference speedup-t3e -o s.db
    stderr_says "the scenario has no 'jobs' to combine"
    fails_with 65 mimdsim run speedup-t3e -o s.db --set combinations=pairs
    stderr_says "the scenario has no 'jobs' to combine"
    refused "'background' is what takes the place of all other jobs" 'jobs: [{name: background, kernel: barrier, ranks: 4}]'
}

@test "verbs that look at one program alone say so" {
    scenario "${two[@]}"
    fails_with 78 mimdsim why s.yaml -o s.db
    stderr_says "job 'solver' shares it; take the scenario without 'jobs'"
    works mimdsim run s.yaml -o s.db --quiet
    fails_with 78 mimdsim why s.db 1
    stderr_says "job 'solver' shares it; take the scenario without 'jobs'"
    # before it is asked how many processes there are
    ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0 fails_with 78 mimdsim run s.yaml --backend mpi -o r.db # MPI leaks
    stderr_is "mimdsim: job 'solver' shares its machine with others, which a real run cannot: take the scenario without 'jobs'"
    [ ! -e r.db ]
    works mimdsim explain s.yaml
    stdout_says 'on one machine'
    stdout_says 'solver'
    works mimdsim check s.yaml
}
