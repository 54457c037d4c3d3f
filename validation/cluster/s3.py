"""A batch of files in a store of objects, of a moto server on this machine, against the plain call with the same bytes in memory:

    python validation/cluster/s3.py [--files 200] [--shards 8]

Python needs palpate, `validation/cluster/requirements.txt`, and `moto[server]` and `s3fs`. Exit code 1 if a byte differs.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import sys
import tempfile
import time

import numpy as np
import palpate
import palpate.dask
import pandas


def hold(index: int) -> bytes:
    """Displacement and force of a ramp of 1 s and a hold, with noise of its own."""
    times = np.arange(0.0, 13.0, 0.05)
    force = np.where(times < 1.0, 2.0 * times, 1.0 + (1.0 + 4.0 * np.maximum(times - 1.0, 0.0)) ** -0.25)
    force += np.random.default_rng(index).normal(0.0, 1e-3, times.size)
    rows = "".join(f"{t:.3f},{min(t, 1.0):.5f},{f:.6f}\n" for t, f in zip(times, force, strict=True))
    return ("time_s,displacement_mm,force_n\n" + rows).encode()


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--files", type=int, default=200)
    parser.add_argument("--shards", type=int, default=8)
    wanted = parser.parse_args()
    os.environ.update(AWS_ACCESS_KEY_ID="test", AWS_SECRET_ACCESS_KEY="test", AWS_DEFAULT_REGION="us-east-1")
    from moto.server import ThreadedMotoServer

    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    server.start()
    host, port = server.get_host_and_port()
    options = {"endpoint_url": f"http://{host}:{port}"}
    import s3fs
    from distributed import Client, LocalCluster

    store = s3fs.S3FileSystem(**options)
    store.mkdir("lab")
    files = {f"s3://lab/curves/c{index:05}.csv": hold(index) for index in range(wanted.files)}
    files["s3://lab/curves/broken.csv"] = b"time,force\n1,x\n"
    for name, content in sorted(files.items()):
        store.pipe_file(name, content)
    with tempfile.TemporaryDirectory() as scratch, LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
        folder = pathlib.Path(scratch)
        start = time.perf_counter()
        palpate.batch(dict(sorted(files.items())), folder / "whole.parquet")
        whole_s = time.perf_counter() - start
        with Client(cluster) as client:
            start = time.perf_counter()
            done = palpate.dask.batch(["s3://lab/curves/*.csv"], folder / "holds", client, shards=wanted.shards, storage_options=options)
            store_s = time.perf_counter() - start
        done.merge(folder / "merged.parquet")
        same = (folder / "whole.parquet").read_bytes() == (folder / "merged.parquet").read_bytes()
        failures = pandas.read_parquet(done.failures)
    server.stop()
    print(f"{done.tests} tests in {wanted.files + 1} objects, {done.failed} failed ({', '.join(failures.record)}), {done.count} shards")
    print(f"from the store {store_s:.1f} s, in memory {whole_s:.1f} s")
    print("same bytes" if same else "OTHER BYTES")
    return 0 if same and done.failed == 1 else 1


if __name__ == "__main__":
    sys.exit(main())
