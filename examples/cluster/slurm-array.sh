#!/bin/sh
# sh slurm-array.sh SCENARIO OUT.db SHARDS - one campaign as an array of Slurm jobs, merged by a last job.
#
# Each task of the array runs one shard into a database of its own. The last job starts when all of them
# have ended well; when one has not, it is cancelled and this script fails. Submit again after a failure:
# shards continue where they stopped. What a shard says is in OUT.db.shard-K.log.
set -eu
scenario=$1 out=$2 shards=$3
mimdsim=${MIMDSIM:-mimdsim}

array=$(sbatch --parsable --array="1-$shards" --cpus-per-task=1 --output="$out.shard-%a.log" --wrap \
    "'$mimdsim' run '$scenario' --shard \$SLURM_ARRAY_TASK_ID/$shards --jobs 1 --quiet -o '$out.shard-'\$SLURM_ARRAY_TASK_ID")
sbatch --wait --dependency="afterok:$array" --kill-on-invalid-dep=yes --output="$out.merge.log" --wrap \
    "'$mimdsim' merge '$out' $(seq -s ' ' -f "'$out.shard-%g'" "$shards")"
