#!/usr/bin/env bats
# accuracy.bats - the verbs that tell how wrong and how stable each way is, through the real program.

load helper

scenario() {
    printf '%s\n' 'schema_version: 1' 'question: Small?' 'machine: t3e-300' \
        'model: {generator: serial-chain}' 'kernel: dynamics' 'ranks: n' 'n: 4' "$@" >small.yaml
}

@test "accuracy stores three ladders, draws them and ends with a line each" {
    scenario
    works mimdsim accuracy small.yaml --within 2%
    stdout_says 'network (n=P=4, makespan within 0.02)'
    stdout_says 'integration (n=P=4, state within 1e-06)'
    sql_is mimdsim.db 'SELECT count(DISTINCT ladder), count(DISTINCT scenario) FROM ladder' '3|1'
    sql_is mimdsim.db "SELECT count(*) FROM ladder WHERE ladder = 'network' AND method = 'flit' AND relative_error <> 0" 0
    sql_is mimdsim.db "SELECT count(*) > 0 FROM ladder WHERE status = 'failed' AND text <> ''" 1
    sql_is mimdsim.db 'SELECT count(*) FROM ladder_choice WHERE relative_error <= tolerance AND cost_ratio > 0' 4
    for ladder in network arithmetic integration; do
        [ -s figures/accuracy-small-$ladder.png ] && [ -s figures/accuracy-small-$ladder.csv ]
        stderr_says "figure figures/accuracy-small-$ladder.png"
    done
}

@test "a scene in which nothing can move has ladders and grades all the same" {
    scenario
    works mimdsim accuracy small.yaml --quiet --set model.joint=fixed
    stdout_says 'network (n=P=4, makespan within 0.02)'
    works mimdsim stability small.yaml --quiet --set model.joint=fixed
    stdout_says ' 0 failed of '
    works mimdsim explain small.yaml --measure --quiet --set model.joint=fixed
}

@test "a motion that ends in no numbers is no reference, and its ladder is drawn all the same" {
    scenario
    works mimdsim accuracy small.yaml --quiet --set model.generator=polymer --set n=1 --set 'model.damping=1e15 N m s/rad' \
        --set 'model.torque=1e-300 N m'
    stdout_says 'integration (state within 1e-06): no method has a result'
    sql_is mimdsim.db "SELECT count(*), max(status), max(text) FROM ladder WHERE ladder = 'integration'" \
        "1|failed|integrator 'rk8pd' produced a value that is not a finite number"
    [ -s figures/accuracy-small-integration.png ]
}

@test "accuracy answers in JSON and refuses what is no tolerance" {
    scenario
    works mimdsim accuracy small.yaml --json
    json_is_valid
    json_is '$.choices[0].ladder' network
    fails_with 64 mimdsim accuracy small.yaml --within huh
    stderr_says "'huh' is not a positive number"
    fails_with 64 mimdsim accuracy small.yaml --within=-1
}

@test "stability grades the scenes of a scenario, draws and stores them" {
    scenario
    works mimdsim stability small.yaml
    stdout_says ' ok, '
    sql_is mimdsim.db "SELECT status, relative_error < 1e-13 FROM stability WHERE algorithm = 'aba' AND precision = 'double'" 'ok|1'
    sql_is mimdsim.db "SELECT count(*) > 10, count(residual) > 10 FROM stability" '1|1'
    [ -s figures/stability-small-cases.png ]
    works mimdsim stability small.yaml --json
    json_is_valid
    # scenes are told apart by their n, which a comma would cut off in the figure
    works mimdsim stability small.yaml --set n=2,3 -o two.db --dir two
    grep -q 'small point 2: n = 3' two/stability-small-cases.cases.csv
}

@test "what is left out is stored with the row, and keeping it answers the same" {
    scenario 'level: auto'
    works mimdsim run small.yaml --quiet
    sql_is mimdsim.db "SELECT left_out LIKE '%external forces%timeline%', residual < 1e-9, condition > 1 FROM run" '1|1|1'
    sql_is mimdsim.db "SELECT class, bound IS NULL FROM run_omission WHERE what = 'external forces'" 'exact|1'
    sql_is mimdsim.db "SELECT class, bound < 1e-7 FROM run_omission WHERE what = 'branch and loop phases'" 'bounded|1'
    sql_is mimdsim.db "SELECT count(*) FROM run_omission WHERE what = 'velocity terms'" 0
    works mimdsim run small.yaml --keep-all --quiet
    sql_is mimdsim.db "SELECT left_out, status, residual < 1e-9 FROM run" '|ok|1'
    sql_is mimdsim.db "SELECT count(*) FROM run_omission" 0
    works mimdsim run small.yaml --quiet --force --set model.rate=0rad/s
    sql_is mimdsim.db "SELECT class FROM run_omission WHERE what = 'velocity terms'" exact
}

@test "a planar scene is computed in three components, against serial codes in three, unless told otherwise" {
    scenario 'sweep: {kernel.algebra: [spatial, auto, planar]}'
    works mimdsim run small.yaml --quiet --set model.axes=parallel
    sql_is mimdsim.db "SELECT count(*), sum(status = 'ok') FROM run" '3|3'
    sql_is mimdsim.db "SELECT s.sent_bytes > 3 * p.sent_bytes, s.makespan_ps > p.makespan_ps, p.makespan_ps = q.makespan_ps
        FROM run s, run p, run q WHERE s.id = 1 AND p.id = 2 AND q.id = 3" '1|1|1'
    sql_is mimdsim.db "SELECT s.time_ps > 2 * p.time_ps FROM baseline s, baseline p
        WHERE s.run_id = 1 AND p.run_id = 2 AND s.name = 'rnea+aba' AND p.name = 'rnea+aba'" 1
    sql_is mimdsim.db "SELECT group_concat(name, ', ') FROM (SELECT name FROM baseline WHERE run_id = 2 ORDER BY ordinal)" \
        'parallel code on one processor, rnea, rnea+aba, fastest serial'
    sql_is mimdsim.db "SELECT run_id, class, bound < 1e-7 FROM run_omission WHERE what = 'out-of-plane components'" \
        "$(printf '%s\n' '2|bounded|1' '3|bounded|1')"
    works mimdsim run small.yaml --quiet --force --keep-all --set model.axes=parallel --set kernel.algebra=auto
    sql_is mimdsim.db "SELECT count(*) FROM run_omission WHERE what = 'out-of-plane components' AND run_id > 3" 0
}

@test "three components are refused where a body leaves the plane, and never chosen for dense operators" {
    scenario
    fails_with 78 mimdsim run small.yaml --quiet --set kernel.algebra=planar
    stderr_says "the scene is not planar: the revolute joint of 'body 1' leaves the plane"
    works mimdsim explain small.yaml --set model.axes=parallel --set kernel.operators=dense
    [[ $output != *out-of-plane* ]]
}

@test "bodies on fixed joints are merged where that leaves enough, and counted all the same" {
    scenario
    works mimdsim run small.yaml --quiet --set n=48 --set ranks=8 --set model.joint=mixed
    sql_is mimdsim.db "SELECT n, status, class, bound < 1e-7 FROM run JOIN run_omission ON run_id = id WHERE what = 'fixed joints'" '48|ok|bounded|1'
    works mimdsim run small.yaml --quiet --set n=48 --set ranks=8 --set model.joint=mixed --keep-all
    sql_is mimdsim.db "SELECT n, status, (SELECT count(*) FROM run_omission) FROM run" '48|ok|0'
    works mimdsim run small.yaml --quiet --set n=48 --set ranks=48 --set model.joint=mixed
    sql_is mimdsim.db "SELECT count(*) FROM run_omission JOIN run ON run_id = id WHERE P = 48 AND what = 'fixed joints'" 0
}

@test "the serial codes that are needed are those that can be the fastest" {
    scenario
    works mimdsim run small.yaml --quiet --set n=128
    all=$(sql mimdsim.db "SELECT time_ps FROM baseline WHERE name = 'fastest serial'")
    sql_is mimdsim.db "SELECT count(*) FROM baseline WHERE name = 'rnea+crba'" 1
    works mimdsim run small.yaml --quiet --set n=128 --set record.baselines=needed --force
    sql_is mimdsim.db "SELECT count(*) FROM run_omission WHERE what = 'serial codes that cannot be fastest'" 1
    sql_is mimdsim.db "SELECT group_concat(b.name, ',') FROM baseline b JOIN run_omission o ON o.run_id = b.run_id
        WHERE o.what = 'serial codes that cannot be fastest' AND b.name LIKE '%crba'" ''
    sql_is mimdsim.db "SELECT DISTINCT time_ps FROM baseline WHERE name = 'fastest serial'" "$all"
}

@test "explain lists every kind that some run leaves out, and the settings that act nowhere" {
    scenario 'sweep: {level: [loggp, auto], model.rate: [0 rad/s, 1 rad/s]}'
    works mimdsim explain small.yaml
    stdout_says 'left out (exact, in 2 of 4 runs): velocity terms: all joint rates are zero, without time steps'
    stdout_says 'left out (exact, in 2 of 4 runs): contention where routes share no link'
    stdout_says 'left out (bounded by 2.0e-08): branch and loop phases'
    works mimdsim explain small.yaml --json
    json_is_valid
    json_is "$.omissions[#-1].class" exact
    scenario
    works mimdsim explain small.yaml --set kernel.name=forward --set kernel.formulation=direct --set model.rate=0rad/s \
        --set kernel.composites_incoming=true
    stdout_says 'unused: kernel.composites_incoming: nothing moves, so the direct formulation scans nothing'
    works mimdsim explain small.yaml --set model.generator=vector --set kernel.solver=cr \
        --set "model.path=$MIMDSIM_SRCDIR/tests/data/vectors/closed_fourbar.json" --set ranks=2
    stdout_says "unused: kernel.solver: the file's model branches or closes loops: it is contracted"
}

@test "explain measures what leaving out saves, stores and draws it" {
    scenario
    works mimdsim explain small.yaml --measure
    stdout_says 'left out (exact): external forces'
    stdout_says 'events that start messages'
    stdout_says 'bounded'
    # what a put-back costs the machine is what the database says, and what a run that keeps it takes
    sql_is mimdsim.db "SELECT machine_saved_ps > 0, host_noise_s > 0, at FROM omission WHERE what = 'external forces'" '1|1|n=P=4'
    sql_is mimdsim.db "SELECT machine_saved_ps, class FROM omission WHERE what = 'timeline'" '0|exact'
    sql_is mimdsim.db "SELECT class, bound > 0, machine_saved_ps <> 0 FROM omission WHERE what = 'branch and loop phases'" 'bounded|1|1'
    [ -s figures/omissions-small.png ]
    grep -q 'external forces' figures/omissions-small.csv
    works mimdsim explain small.yaml --measure --json
    json_is_valid
    json_is '$.savings[0].what' 'external forces'
}

@test "level auto-tolerance takes the cheapest level that its ladder allows, and says how wrong it is" {
    scenario 'level: auto-tolerance 20%'
    sed -i 's/n: 4/n: 8/' small.yaml
    works mimdsim run small.yaml
    stderr_says 'level loggp'
    stderr_says 'measured now'
    sql_is mimdsim.db "SELECT level, level_asked, level_error <= 0.2, level_error_at FROM run" 'loggp|auto-tolerance 20 %|1|n=P=8'
    # the error it tells is that of the makespan against the finest level, measured here by hand
    works mimdsim run small.yaml --quiet --set level=flit
    sql_is mimdsim.db "SELECT abs(a.level_error - abs(1.0 * a.makespan_ps / b.makespan_ps - 1)) < 1e-12
        FROM run a, run b WHERE a.level = 'loggp' AND b.level = 'flit'" 1
    works mimdsim run small.yaml --set level='auto-tolerance 0%'
    stderr_says 'level auto, whose error at n=P=8 is 0 % (stored'
    sql_is mimdsim.db "SELECT count(*) FROM ladder WHERE quantity = 'makespan' AND method = 'flit'" 1
    works mimdsim run small.yaml # its level is settled: nothing is run again
    stderr_says "1 of 1 runs are stored already"
}

@test "level auto-tolerance wants a percentage, and a level where nothing could settle it" {
    scenario
    fails_with 65 mimdsim run small.yaml --set level='auto-tolerance 2'
    stderr_says "no unit; expected a percentage such as '5 %'"
    fails_with 65 mimdsim run small.yaml --set level='auto-tolerance huh'
    fails_with 65 mimdsim run small.yaml --set level='auto-tolerance -1%'
    works mimdsim run small.yaml --quiet --set level=link --set machine.network.tolerance=1%
}

@test "the report tells what the three commands stored, from the database alone" {
    plain_build_only
    scenario
    works mimdsim accuracy small.yaml --quiet
    works mimdsim stability small.yaml --quiet
    works mimdsim explain small.yaml --measure --quiet
    # a rung and a case that failed are planted; nothing may hide them
    sqlite3 mimdsim.db "UPDATE ladder SET status = 'failed', relative_error = NULL, text = 'planted, on purpose'
                            WHERE method = 'rkck' AND rung = 'tolerance 1e-05';
                        UPDATE ladder SET status = 'failed', relative_error = 0.25 WHERE method = 'rkck' AND rung = 'tolerance 1e-07';
                        UPDATE stability SET status = 'failed', relative_error = 1234 WHERE algorithm = 'crba'"
    rm -r figures small.yaml
    works mimdsim report
    stdout_says mimdsim.md
    [ -s mimdsim.html ]
    for section in 'Error against run time' 'Stability' 'Omissions'; do grep -q "^## $section" mimdsim.md; done
    ! grep -q '^## The claims' mimdsim.md
    for figure in accuracy-small-network accuracy-small-arithmetic accuracy-small-integration stability-small-cases omissions-small; do
        [ -s "figures/$figure.png" ] && [ "$(wc -l <figures/$figure.csv)" -gt 2 ]
        grep -q "(figures/$figure.svg)" mimdsim.md
    done
    grep -q 'rkck | tolerance 1e-05 | planted, on purpose' mimdsim.md
    grep -q 'rkck | tolerance 1e-07 | error 2.5e-01 |' mimdsim.md
    grep -q 'rkck: 1e-05' figures/accuracy-small-integration.failed.csv
    grep -q '| crba | double | 0 | 0 | 1 | 1.2e+03 |' mimdsim.md
    cheapest=$(sql mimdsim.db "SELECT method FROM ladder_choice WHERE ladder = 'network'")
    grep -q "cheapest is $cheapest" mimdsim.md
    counts=$(sql mimdsim.db "SELECT format('%d ok, %d degraded, %d failed', sum(status = 'ok'), sum(status = 'degraded'), sum(status = 'failed')) FROM stability")
    grep -q "^$counts" mimdsim.md
    saved=$(sql mimdsim.db "SELECT format('%.4g us', machine_saved_ps / 1e6) FROM omission WHERE what = 'external forces'")
    grep -q "external forces .* $saved" mimdsim.md
    grep -q '^mimdsim ' figures/stability-small-cases.provenance
    works mimdsim report --json
    json_is_valid
    json_is '$[0]' mimdsim.md
    # without gnuplot the numbers of every drawing are there, and the report says so
    sqlite3 mimdsim.db "UPDATE omission SET scenario = 'other' WHERE what = 'timeline'"
    rm -r figures
    MIMDSIM_GNUPLOT=/nonexistent fails_with 69 mimdsim report
    stderr_says 'the report mimdsim.html has no pictures, or not all of them'
    stdout_says mimdsim.html
    [ -s figures/omissions-small.csv ] && [ -s figures/omissions-other.csv ] && [ ! -e figures/omissions-other.png ]
    grep -q 'This figure was not drawn' mimdsim.md
    # a database without rows for a figure leaves alone what another's report shows
    works mimdsim report
    works mimdsim run speedup-t3e --set n=4 -o other.db --quiet
    works mimdsim report other.db
    [ -s figures/fig6.svg ] && [ -s figures/stability-small-cases.svg ]
    grep -q '| runs that do not add up |' other.md
    works mimdsim report
    [ -s figures/fig6.svg ] && [ -s figures/fig6.csv ]
    fails_with 66 mimdsim report none.db
}

@test "a figure of the ladders draws no exact answer at a decade, and one scenario alone when asked" {
    scenario
    works mimdsim accuracy small.yaml --quiet
    sqlite3 mimdsim.db "INSERT INTO ladder (scenario, ladder, at, family, method, rung, ordinal, quantity, reference,
                            relative_error, host_s, machine_ps, status, text) SELECT 'other', ladder, at, family, method, rung, ordinal, quantity, reference,
                            relative_error, host_s, machine_ps, status, text FROM ladder"
    works mimdsim plot mimdsim.db accuracy --dir both
    stdout_says both/accuracy-other-network.png
    [ -s both/accuracy-small-network.svg ] && [ -s both/accuracy-other-network.svg ]
    works mimdsim plot mimdsim.db accuracy-other --dir one
    [ -s one/accuracy-other-network.svg ] && [ ! -e one/accuracy-small-network.svg ]
    grep -q '>exact<' one/accuracy-other-network.svg
    # one ladder alone, too
    works mimdsim plot mimdsim.db accuracy-other-arithmetic --dir alone
    [ "$(ls alone/*.svg)" = alone/accuracy-other-arithmetic.svg ]
    # what is exact has no other error in the numbers beside the picture
    sqlite3 :memory: ".import --csv one/accuracy-other-network.csv t" "SELECT count(*) FROM t WHERE method = 'flit' AND relative_error + 0 <> 0" | grep -qx 0
    # the rung that a ring marks is the one that was chosen
    chosen=$(sql mimdsim.db "SELECT method || rung FROM ladder_choice WHERE ladder = 'arithmetic'")
    sqlite3 :memory: ".import --csv both/accuracy-small-arithmetic.csv t" "SELECT method || rung FROM t WHERE chosen = 1 AND block = 2" | grep -qxF "$chosen"
    fails_with 66 mimdsim plot mimdsim.db accuracy-nobody
}

@test "explain names machine and level of every run, and says when a level is still open" {
    scenario 'level: auto-tolerance 5%'
    works mimdsim explain small.yaml
    stdout_says 't3e-300      dynamics   paper        auto-tolerance'
    stdout_says 'level auto-tolerance is settled when it runs'
    works mimdsim explain small.yaml --set level=loggp --json
    json_is '$.runs[0].level' loggp
    json_is '$.runs[0].machine' t3e-300
}

@test "a scenario may have a name that no program likes" {
    scenario
    mv small.yaml "o'neil 5%.yaml"
    works mimdsim explain "o'neil 5%.yaml" --measure --quiet
    [ -s "figures/omissions-o'neil 5%.png" ]
    works mimdsim report
    grep -qF "(figures/omissions-o%27neil%205%25.svg)" mimdsim.md
}

@test "the report counts what the suite's formulations answer" {
    scenario
    works mimdsim stability small.yaml --quiet
    sqlite3 mimdsim.db "UPDATE stability SET suite = 'suite';
                        UPDATE stability SET status = 'failed' WHERE algorithm = 'paper pcr'"
    works mimdsim report
    grep -q "the paper's formulation gives 2 of 3 answers ok, 0 degraded and 1 failed; the direct formulation 3 of 3, 0 and 0" mimdsim.md
    [ -s figures/stability-suite-sizes.png ]
}

@test "stability carries a stiff polymer to rest by implicit steppers alone" {
    works mimdsim stability stiff-polymer --quiet
    sql_is mimdsim.db "SELECT group_concat(DISTINCT status) FROM stability WHERE algorithm IN ('own implicit', 'bsimp', 'msbdf')" ok
    sql_is mimdsim.db "SELECT count(*) FROM stability WHERE algorithm IN ('own rk4', 'rkf45') AND status = 'ok'" 0
}
