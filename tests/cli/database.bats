# database.bats - the tables of the database: none of their columns is lost, and each is documented.
load helper

small_database() {
    printf '%s\n' 'schema_version: 1' 'question: One?' 'machine: t3e-300' 'model: {generator: serial-chain}' \
        'n: 4' 'ranks: 2' 'level: link' 'kernel: dynamics' 'record: {spans: true, links: true}' >own.yaml
    works mimdsim run own.yaml -o own.db --quiet
}

columns_of() {
    works mimdsim query "$1" "SELECT m.type || '|' || m.name || '|' || p.name || '|' || p.type || '|' ||
        p.\"notnull\" || '|' || p.pk AS line FROM sqlite_schema m, pragma_table_info(m.name) p
        WHERE m.type IN ('table', 'view') ORDER BY m.name, p.cid"
}

@test "every column of the tables and views of schema version 5 is there, with its type and key" {
    small_database
    columns_of own.db
    # rank_stage is a view since version 7, link_load since 10, values of settings are computed since version 9: names, no types.
    missing=$(sed -E 's/^table\|(rank_stage|link_load)\|([a-z_]+)\|.*/\1.\2/; s/^(view\|v_(setting|itervar)\|value)\|TEXT/\1|/; s/^(view\|v_link_top\|.*)INTEGER\|/\1|/' "$MIMDSIM_SRCDIR/tests/data/schema/version-5.txt" |
        sort | comm -23 - <(printf '%s\n' "$output" |
            sed -E 's/ *$//; s/^(view\|v_link_top\|.*)INTEGER\|/\1|/; s/^view\|(rank_stage|link_load)\|([a-z_]+)\|.*/\1.\2/' | sort))
    [ -z "$missing" ] || { echo "not there: $missing"; return 1; }
    [ "$(wc -l <"$MIMDSIM_SRCDIR/tests/data/schema/version-5.txt")" -gt 400 ]
}

@test "docs/database.md is what query --schema writes, and says something of every column" {
    works mimdsim query --schema
    stderr_is_empty
    diff -u "$MIMDSIM_SRCDIR/docs/database.md" <(printf '%s\n' "$output")
    [ "$(grep -c '^| `' <<<"$output")" -gt 400 ]
    ! grep '| - |$' <<<"$output"
    fails_with 64 mimdsim query --schema mimdsim.db
    fails_with 64 mimdsim query --schema --json
}

@test "all rows of a run are there: stages, ranks, baselines, checks, links, spans" {
    small_database
    for table in run stage rank_stage baseline error_check run_omission link_load span; do
        works mimdsim query own.db "SELECT count(*) > 0 AS n FROM $table"
        [ "${lines[1]}" = 1 ] || { echo "no rows in $table"; return 1; }
    done
    sql_is own.db "SELECT sum(kind IN ('compute', 'send', 'recv', 'wait', 'barrier')) = count(*) FROM span" 1
    sql_is own.db "SELECT count(*) FROM error_check WHERE passed <> (relative_error <= tolerance)" 0
}
