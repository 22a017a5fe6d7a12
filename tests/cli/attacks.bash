# attacks.bash - databases whose texts are commands, and all figures of them. After `load helper`.

# speedup is that of programs of one's own, which need a compiler.
figures() {
    (cd "$MIMDSIM_DATA/plots" && for f in *.gp; do
        case $f in style.gp | _*) ;; speedup.gp) ! command -v gcc >/dev/null || echo speedup ;; *) echo "${f%.gp}" ;; esac
    done)
}

# every_figure: all.db, a database with rows for every figure.
every_figure() {
    if [ -e "$BATS_FILE_TMPDIR/all.db" ]; then cp "$BATS_FILE_TMPDIR/all.db" .; return; fi
    printf '%s\n' 'schema_version: 1' 'question: Small?' 'machine: t3e-300' \
        'model: {generator: serial-chain}' 'kernel: dynamics' 'ranks: n' 'n: 4' >small.yaml
    for scenario in fig5 fig6 fig8 bisection pingpong-machines; do works mimdsim run $scenario -o all.db --quiet; done
    works mimdsim run fig7 --set n=16 -o all.db --quiet
    works mimdsim run fig9 --set ranks=1,2,4,8 -o all.db --quiet
    works mimdsim run fig9-machines --set ranks=1,2,4,8 -o all.db --quiet
    works mimdsim run fig6-machines --set n=2,4,8 -o all.db --quiet
    if command -v gcc >/dev/null; then
        works env XDG_CACHE_HOME="$BATS_TEST_TMPDIR" "$MIMDSIM" run "$MIMDSIM_SRCDIR/examples/prefix-sum.yaml" --set n=100 \
            --set ranks=1,2 -o all.db --quiet
    fi
    works mimdsim why small.yaml -o all.db --quiet
    works mimdsim run small.yaml --uncertainty 8 -o all.db --quiet
    works mimdsim accuracy small.yaml -o all.db --quiet
    works mimdsim stability small.yaml -o all.db --quiet
    works mimdsim explain small.yaml --measure -o all.db --quiet
    works mimdsim load t3e-300 --level packet --rates 0.02,0.05 --no-saturation --messages 10000 -o all.db --quiet
    works mimdsim interference neighbours -o all.db --dir neighbours --quiet
    run mimdsim validate paragon -o all.db --quiet
    run mimdsim claims all.db
    # a plane of two parameters, by hand: to simulate one takes long
    sqlite3 all.db "INSERT INTO explain_point VALUES (1, 'C1', 'key', 'structured', '', 0, 1, 'runs');
        INSERT INTO explain_judged VALUES (1, 'C1', 'variant', 1.0, 0.5, 1);
        INSERT INTO explain_map WITH k(v) AS (VALUES (0), (1))
            SELECT 'C1', a.v, b.v, 'node.call', 'node.flop_rate', 'node.call (50 ns)', 'node.flop_rate (45 Mflop/s)', 0.5 + a.v,
                   0.5 + b.v, 0.5, 1.5, NULL, NULL, 1, 1, 1.2, 1.3, 'variant', 1 FROM k a, k b;
        INSERT INTO explain_answer VALUES ('C1', 'own', 'holds', 'variant', 'structured', '', 0.5, 1, 0.5, 4, 1, 1, 'A sentence.')"
    cp all.db "$BATS_FILE_TMPDIR/"
}

# text_columns: TABLE.COLUMN of every text column of every table that may hold any text.
text_columns() {
    sql all.db "SELECT m.name || '.' || c.name FROM sqlite_schema m, pragma_table_info(m.name) c
                WHERE m.type = 'table' AND c.type = 'TEXT' AND m.sql NOT LIKE '%CHECK (' || c.name || ' IN (%' ORDER BY 1"
}

# word_columns: of those that may hold certain words alone.
word_columns() {
    sql all.db "SELECT m.name || '.' || c.name FROM sqlite_schema m, pragma_table_info(m.name) c
                WHERE m.type = 'table' AND c.type = 'TEXT' AND m.sql LIKE '%CHECK (' || c.name || ' IN (%' ORDER BY 1"
}

# add_to FILE COLUMNS: each text of COLUMNS gets what FILE holds at its end. A column under a CHECK takes it all the same.
add_to() {
    local column where
    cp all.db bad.db
    {
        echo 'PRAGMA ignore_check_constraints = ON; PRAGMA foreign_keys = OFF; BEGIN;'
        for column in $2; do
            # one stage has to keep its name for figure 7
            if [ "$column" = stage.name ]; then where="WHERE name <> 'CFA[2]'"; else where=; fi
            echo "UPDATE ${column%.*} SET ${column#*.} = ${column#*.} || CAST(readfile('$1') AS TEXT) $where;"
        done
        echo 'COMMIT;'
    } | sqlite3 bad.db
}

# svg_alone: the PNG of a figure comes from the same commands; where many figures are drawn their SVG tells as much.
svg_alone() { export MIMDSIM_GNUPLOT=$MIMDSIM_SRCDIR/tests/support/gnuplot-svg.sh; }

# draw_all STATUS...: every figure of bad.db ends with one of STATUS; no command of a text has run, no picture is active.
draw_all() {
    local figure
    rm -rf drawn
    if [ "$*" = 0 ]; then
        # shellcheck disable=SC2046 # one word a figure; the first that fails ends it, and is told
        works mimdsim plot bad.db $(figures) --dir drawn
    else for figure in $(figures); do
        run --separate-stderr -- mimdsim plot bad.db "$figure" --dir drawn
        case " $* " in *" $status "*) ;; *) echo "$figure"; show; return 1 ;; esac
    done; fi
    [ -z "$(find "$BATS_TEST_TMPDIR" -name 'PWNED?')" ] || { echo 'a text was run as a command'; return 1; }
    ! grep -rqi '<script' --include='*.svg' . || { echo 'a text became a part of a picture'; return 1; }
}
