#!/bin/bash
# The shards of a batch as an array of jobs, and a job that merges them: submit.sh N RECORDS TEST.toml OUT
set -euo pipefail
array=$(sbatch --parsable --array="1-$1" "$(dirname "$0")/array.sbatch" "$@")
sbatch --parsable --job-name=merge --output=slurm-%j.txt --dependency="afterany:$array" \
    --wrap="palpate merge '$4' --out '$4.parquet'"
