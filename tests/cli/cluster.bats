# cluster.bats - the examples of campaigns on other engines: each gives the rows of an undisturbed campaign. An engine that
# is not installed skips its test.
load helper
load campaigns
load one-node-slurm

teardown() { stop_slurm; }

@test "Slurm: an array of jobs runs the shards, a last job merges them; what fails is told, and continued" {
    for program in munged slurmctld slurmd sbatch; do command -v $program >/dev/null || skip "no $program"; done
    [ "$(id -u)" -eq 0 ] || skip "Slurm's daemons want root"
    many 8
    works mimdsim run own.yaml -o whole.db --quiet
    start_slurm "$PWD/slurm" || { cat slurm/*.log; false; }
    # A program that is not there: the last job never starts, and the script ends all the same.
    ! MIMDSIM=/nowhere/mimdsim timeout 600 sh "$MIMDSIM_SRCDIR/examples/cluster/slurm-array.sh" own.yaml all.db 2
    [ ! -e all.db ]
    grep '/nowhere/mimdsim' all.db.shard-1.log
    # A shard that was killed before.
    "$MIMDSIM" run own.yaml --shard 2/2 -o all.db.shard-2 --jobs 1 --quiet >/dev/null 3>&- &
    sleep 0.1
    kill -9 $! 2>/dev/null || true
    wait $! || true
    works timeout 600 sh "$MIMDSIM_SRCDIR/examples/cluster/slurm-array.sh" own.yaml all.db 2
    diff <(rows whole.db) <(rows all.db)
}

@test "Snakemake: the shards are rules, and what is there is not made again" {
    command -v snakemake >/dev/null || skip "no snakemake"
    many 8
    works mimdsim run own.yaml -o whole.db --quiet
    mkdir path
    ln -s "$MIMDSIM" path/mimdsim
    export PATH=$PWD/path:$PATH
    works timeout 600 snakemake -s "$MIMDSIM_SRCDIR/examples/cluster/Snakefile" --cores 2 --config scenario=own.yaml shards=2
    diff <(rows whole.db) <(rows campaign.db)
    rm campaign.db shard-2.db
    works timeout 600 snakemake -s "$MIMDSIM_SRCDIR/examples/cluster/Snakefile" --cores 2 --config scenario=own.yaml shards=2
    [[ $stderr == *shard-2.db* && $stderr != *"output: shard-1.db"* ]]
    diff <(rows whole.db) <(rows campaign.db)
}
