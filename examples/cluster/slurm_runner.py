"""Shards through Dask within one job of Slurm: srun --ntasks=4 python slurm_runner.py N RECORDS TEST.toml OUT"""

import sys

from dask.distributed import Client
from dask_jobqueue.slurm import SLURMRunner

import palpate.dask

if __name__ == "__main__":
    shards, records, test, out = sys.argv[1:]
    # Task 0 is the scheduler, task 1 goes on here as the client, the others are workers.
    with SLURMRunner(worker_options={"nthreads": 1}) as runner, Client(runner) as client:
        client.wait_for_workers(runner.n_workers)
        result = palpate.dask.batch([records], out, client=client, shards=int(shards), test=test)
        result.merge(f"{out}.parquet")
