"""A client of Dask as a process that can be killed: shards of a batch through `palpate.dask`, and their merge.

    python validation/cluster/dask_job.py FOLDER OUT SHARDS --workers N [--scheduler-file FILE]

FOLDER is that of `curves.py`. Without --scheduler-file it starts a LocalCluster of its own. OUT.json receives the process ids of the workers, and
at the end the seconds that the batch took. Exit code 0 once OUT.parquet is written.
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import time

import dask.config
import dask.distributed

import palpate.dask


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("shards", type=int)
    parser.add_argument("--workers", type=int, required=True)
    parser.add_argument("--scheduler-file")
    wanted = parser.parse_args()
    note = wanted.out.with_name(f"{wanted.out.name}.json")
    cluster = None
    if wanted.scheduler_file is None:
        # Each worker is a process of one thread; no page, no port of its own.
        with dask.config.set(palpate.dask.SETTINGS):
            cluster = dask.distributed.LocalCluster(n_workers=wanted.workers, threads_per_worker=1, dashboard_address=None)
        client = dask.distributed.Client(cluster)
    else:
        client = dask.distributed.Client(scheduler_file=wanted.scheduler_file)
    with client:
        client.wait_for_workers(wanted.workers)
        found = {"workers": list(client.run(os.getpid).values())}
        note.write_text(json.dumps(found))
        start = time.perf_counter()
        files = [str(wanted.folder / "records")]
        result = palpate.dask.batch(files, wanted.out, client=client, shards=wanted.shards, test=wanted.folder / "test.toml")
        found["batch_s"] = time.perf_counter() - start
        result.merge(wanted.out.with_name(f"{wanted.out.name}.parquet"))
        note.write_text(json.dumps(found))
        if cluster is not None:
            cluster.close()


if __name__ == "__main__":
    main()
