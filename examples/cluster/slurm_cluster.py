"""Shards through Dask, whose workers are jobs of Slurm: python slurm_cluster.py N RECORDS TEST.toml OUT"""

import sys

from dask.distributed import Client
from dask_jobqueue import SLURMCluster

import palpate.dask

if __name__ == "__main__":
    shards, records, test, out = sys.argv[1:]
    with SLURMCluster(cores=1, processes=1, memory="1 GiB", walltime="01:00:00") as cluster, Client(cluster) as client:
        cluster.scale(jobs=2)
        result = palpate.dask.batch([records], out, client=client, shards=int(shards), test=test)
        result.merge(f"{out}.parquet")
