#!/bin/bash
# Shards as tasks of HyperQueue, and their merge: hyperqueue.sh N RECORDS TEST.toml OUT
set -euo pipefail
hq submit --name=palpate --array="1-$1" --cpus=1 --crash-limit=5 -- \
    bash -c 'palpate batch "$2" --test "$3" --out "$4" --shard "$HQ_TASK_ID/$1" --threads 1' shard "$@"
hq job wait last
palpate merge "$4" --out "$4.parquet"
