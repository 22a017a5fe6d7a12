#!/bin/sh
# sh gnu-parallel.sh SCENARIO OUT.db [SHARDS] - one campaign on all cores, or on many hosts, by GNU parallel.
#
# Each job runs one shard into a database of its own; the databases are then merged into OUT.db. Run the
# same command again after an interruption: shards continue where they stopped. For several hosts add
# options of parallel, such as `--sshloginfile hosts --workdir .`, by PARALLEL="..." in the environment.
set -eu
scenario=$1 out=$2 shards=${3:-$(nproc)}
mimdsim=${MIMDSIM:-mimdsim}

seq "$shards" | parallel "$mimdsim" run "$scenario" --shard "{}/$shards" --jobs 1 --quiet -o "$out.shard-{}" '>' /dev/null
"$mimdsim" merge "$out" $(seq -f "$out.shard-%g" "$shards")
