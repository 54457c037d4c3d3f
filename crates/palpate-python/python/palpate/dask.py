"""Batches, sweeps and fits on the workers of a Dask cluster: of this machine, of Slurm, or of whatever else gives a Dask client.

A batch or a sweep is divided into shards, the same that ``palpate batch --shard 3/40`` runs. Each is one task, which leaves its tables and
a manifest in a folder that all workers share. What is finished is not computed again: a cluster that was ended goes on where it stood, and
the merged table has the same bytes for any number of workers, shards and kills.

Needs ``dask`` and ``distributed``: ``pip install palpate[dask]``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import palpate
from palpate import _progress
from palpate._fits import fit_many as _fit_many
from palpate._options import Intervals, LawName
from palpate._palpate import _BUILD, BatchResult, OptionError, PalpateError, _found, _run_slice, _sliced

if TYPE_CHECKING:
    import dask.dataframe as dd
    import pandas
    from distributed import Client, Future

    from palpate._palpate import _Slice, _SlicedFile

__all__ = ["Shards", "batch", "fit_many", "sweep"]

#: How often a shard is tried whose worker ended, beside the tries of the scheduler.
_TRIES = 4
#: Shards of a sweep, if nothing else is stated.
_SWEEP_SHARDS = 64
#: Bytes of a shard in a large batch.
_SHARD_BYTES = 16 << 20
#: Bytes of a shard in a small one.
_SMALL_SHARD_BYTES = 256 << 10


@dataclass(frozen=True)
class Shards:
    """The finished shards of a batch or a sweep: three folders of Parquet files with the same columns each."""

    #: The folder of all.
    folder: Path
    #: How many shards there are.
    count: int
    #: Rows of the table.
    rows: int
    #: Tests of the batch; runs of the sweep.
    tests: int
    #: How many of them have no results.
    failed: int

    @property
    def table(self) -> Path:
        """Folder with the table, a file a shard: ``pandas.read_parquet(shards.table)``."""
        return self.folder / "table"

    @property
    def parameters(self) -> Path:
        """Folder with the table of the parameters of a batch."""
        return self.folder / "parameters"

    @property
    def failures(self) -> Path:
        """Folder with the table of the tests of a batch without rows: ``record``, ``part``, ``message``, ``hint``."""
        return self.folder / "failures"

    def merge(
        self, out: str | os.PathLike[str], *, map: Sequence[str] | None = None, csv_locale: str | None = None
    ) -> BatchResult | tuple[int, int]:
        """One table of all shards: `palpate.merge` of the folder."""
        return palpate.merge([self.folder], out, map=map, csv_locale=csv_locale)


def batch(
    files: Iterable[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    client: Client | None = None,
    *,
    shards: int | None = None,
    storage_options: Mapping[str, Any] | None = None,
    test: Any = None,
    columns: Any = None,
    laws: Sequence[LawName] | None = None,
    intervals: Intervals | None = None,
    fit_until_s: float | None = None,
    restart: bool = False,
    progress: bool | None = None,
) -> Shards:
    """Analyse many records on the workers of a Dask cluster, into a folder of shards.

    Parameters
    ----------
    files
        Files, folders with files, or patterns, as for `palpate.batch`; also addresses of fsspec with ``://``, such as
        ``"s3://bucket/curves/*.csv"`` or ``"zip://*.csv::map.zip"``, each of which is fetched by the worker that analyses it.
    out
        Folder of the shards, which all workers share.
    client
        Client of the cluster; if left out, the client at hand, or a cluster of this machine with a worker a processor.
    shards
        How many shards the files make; if left out, as many as the folder has already, or shards of at most 16 MiB of files.
    storage_options
        What fsspec needs besides the addresses.
    test, columns, laws, intervals, fit_until_s, restart
        As for `palpate.batch`.
    progress
        Whether to show a bar of tqdm; if left out, where tqdm is there, standard error is a terminal and it takes a while.

    Returns
    -------
    Shards
        The folders of the tables, with how many tests failed.

    Raises
    ------
    OptionError
        An option that is wrong; workers without palpate, or with another build of it.
    PalpateError
        Shards that could not be finished, with the reason of each. The others are, and another call goes on with those that are missing.

    Examples
    --------
    >>> from distributed import Client, LocalCluster
    >>> with LocalCluster(n_workers=2) as cluster, Client(cluster) as client:  # doctest: +SKIP
    ...     done = palpate.dask.batch(["curves"], "holds", client, test="cell.toml")
    >>> done.merge("holds.parquet")  # doctest: +SKIP
    """
    listed = list(_files([files] if isinstance(files, (str, os.PathLike)) else files, dict(storage_options or {})))
    folder = Path(out).resolve()
    count = shards or _count_of(folder) or _count_for(listed)
    options = {"test": test, "columns": columns, "laws": laws, "intervals": intervals, "fit_until_s": fit_until_s, "restart": restart}
    here = os.getcwd() if any(not isinstance(file[1], int) and not os.path.isabs(file[0]) for file in listed) else None

    def tasks() -> Iterator[tuple[str, Callable[[], tuple[int, int, int]]]]:
        for one in _sliced(listed, count):
            own = listed[one[4] : one[4] + one[5]]
            yield f"{one[0]}/{one[1]}", partial(_batch_shard, _BUILD, here, one, own, folder, options)

    return _driven(client, tasks(), count, folder, progress)


def sweep(
    protocol: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str],
    client: Client | None = None,
    *,
    shards: int | None = None,
    restart: bool = False,
    progress: bool | None = None,
) -> Shards:
    """Simulate the runs of a protocol with a table ``[sweep]`` on the workers of a Dask cluster, into a folder of shards.

    Parameters
    ----------
    protocol, restart
        As for `palpate.sweep`.
    out, client, progress
        As for `batch`.
    shards
        How many shards the runs make; if left out, as many as the folder has already, or 64.

    Returns
    -------
    Shards
        The folder of the table, with how many runs were refused.

    Raises
    ------
    OptionError, PalpateError
        As for `batch`; a protocol without a sweep.
    """
    folder = Path(out).resolve()
    count = shards or _count_of(folder) or _SWEEP_SHARDS
    stated = protocol if isinstance(protocol, Mapping) else Path(protocol).resolve()

    def tasks() -> Iterator[tuple[str, Callable[[], tuple[int, int, int]]]]:
        for number in range(1, count + 1):
            yield f"{number}/{count}", partial(_sweep_shard, _BUILD, stated, folder, f"{number}/{count}", restart)

    return _driven(client, tasks(), count, folder, progress)


def fit_many(
    time_s: Any, signal: Any = None, *, by: str | Sequence[str] | None = None, time: str | None = None, **options: Any
) -> dd.DataFrame:
    """Fit a law to the holds in a collection of Dask, each partition by `palpate.fit_many` on the worker that has it.

    Parameters
    ----------
    time_s, signal
        A `dask.dataframe.DataFrame`, a row a sample, with `by`, `time` and ``signal=`` the names of its columns; or a `dask.array.Array`
        ``signal`` of shape (curves, samples) with ``time_s`` one array for all curves or a Dask array of that shape; or a `dask.bag.Bag`
        of pairs (time_s, signal).
    by, time
        As for `palpate.fit_many`. Rows of one curve are brought together first, unless `by` is the index of the data frame.
    options
        ``law``, ``fixed``, ``bounds`` and all others of `palpate.fit_many`.

    Returns
    -------
    dask.dataframe.DataFrame
        A row a curve with the columns of `palpate.fit_many`, computed when its values are needed. Of an array the index is the number
        of the curve; of a data frame and of a bag there is no column ``curve``.

    Raises
    ------
    OptionError
        As for `palpate.fit_many`; a collection of another kind.
    """
    import dask.array as da
    import dask.bag as db
    import dask.dataframe as dd
    from dask.delayed import delayed

    options = {**options, "progress": False}
    if isinstance(time_s, dd.DataFrame):
        names = [by] if isinstance(by, str) else list(by or ())
        if not names or time is None or not isinstance(signal, str):
            raise OptionError("expected the names of columns beside a data frame: by, time and signal")
        columns = [*names, time, signal]
        is_index = names == [time_s.index.name]
        missing = [name for name in columns if name not in time_s.columns and not (is_index and name == names[0])]
        if missing:
            raise OptionError(f"expected columns {', '.join(columns)}, found no {', '.join(missing)}")
        together = time_s if is_index and time_s.known_divisions else time_s.shuffle(on=names)
        labels = time_s._meta_nonempty.reset_index() if is_index else time_s._meta_nonempty
        times, signals = _example_hold()
        example = labels[names].iloc[[0] * len(times)].assign(**{time: times, signal: signals})
        meta = _fit_frame(example, names, time, signal, options).iloc[:0]
        return together.map_partitions(_fit_frame, names, time, signal, options, meta, meta=meta)
    if isinstance(time_s, db.Bag):
        parts = [delayed(_fit_pairs)(part, options) for part in time_s.to_delayed()]
        return dd.from_delayed(parts, meta=_example(options).drop(columns="curve"))
    if not isinstance(signal, da.Array) or signal.ndim != 2:
        kinds = "a dask.dataframe.DataFrame, a dask.bag.Bag, or a signal that is a dask.array.Array of shape (curves, samples)"
        raise OptionError(f"expected {kinds}, found {type(time_s).__name__} and {type(signal).__name__}")
    rows = signal.rechunk({1: -1})  # pyright: ignore[reportArgumentType]
    if any(size != size for size in rows.chunks[0]):
        rows = rows.compute_chunk_sizes()
    signals = rows.to_delayed()[:, 0]
    times = [time_s] * len(signals)
    if isinstance(time_s, da.Array):
        times = list(time_s.rechunk(rows.chunks).to_delayed()[:, 0]) if time_s.ndim == 2 else [delayed(time_s)] * len(signals)
    starts = [sum(rows.chunks[0][:index]) for index in range(len(signals))]
    fit = delayed(_fit_rows)
    parts = [fit(own, block, start, options) for own, block, start in zip(times, signals, starts, strict=True)]
    return dd.from_delayed(parts, meta=_example(options))


def _example_hold() -> tuple[Any, Any]:
    """A hold that every law can be fitted to."""
    import numpy as np

    times = np.linspace(0.0, 10.0, 64)
    return times, 1.0 + (1.0 + 2.0 * times) ** -0.25


def _example(options: Mapping[str, Any]) -> pandas.DataFrame:
    """The columns of a table of fits, without rows."""
    times, signal = _example_hold()
    return _fit_many([times], [signal], **options).to_pandas().iloc[:0]


def _fit_frame(
    part: pandas.DataFrame, by: list[str], time: str, signal: str, options: Mapping[str, Any], meta: pandas.DataFrame | None = None
) -> pandas.DataFrame:
    if part.empty and meta is not None:
        return meta
    part = part.reset_index() if by == [part.index.name] else part
    fits = _fit_many(part[[*by, time, signal]], by=by, time=time, signal=signal, **options).to_pandas()
    # Labels tell curves apart, not their number in a partition.
    return fits if "curve" in by else fits.drop(columns="curve")


def _fit_pairs(part: Iterable[tuple[Any, Any]], options: Mapping[str, Any]) -> pandas.DataFrame:
    pairs = list(part)
    fits = _fit_many([time for time, _ in pairs], [signal for _, signal in pairs], **options).to_pandas() if pairs else _example(options)
    # A bag does not know how many pairs are in other partitions.
    return fits.drop(columns="curve")


def _fit_rows(time_s: Any, signal: Any, start: int, options: Mapping[str, Any]) -> pandas.DataFrame:
    fits = _fit_many(time_s, signal, **options).to_pandas()
    return fits.assign(curve=fits["curve"] + start).set_axis(range(start, start + len(fits)), axis=0)


def _files(names: Iterable[str | os.PathLike[str]], storage_options: dict[str, Any]) -> Iterator[_SlicedFile]:
    """Files on disks by their names, others by name, size and what fetches them; in the order of a batch."""
    for name in names:
        if not isinstance(name, (str, os.PathLike)):
            raise OptionError(f"files: expected paths and addresses, found {type(name).__name__}")
        if "://" not in os.fspath(name):
            yield from ((path, None) for path in _found([name]))
            continue
        try:
            import fsspec
        except ImportError:
            raise OptionError(f"{name}: expected fsspec to reach it, found none\nhint: install fsspec") from None
        system, _, paths = fsspec.get_fs_token_paths(name, storage_options=storage_options)
        details = {path: system.info(path) for path in paths}
        found = sorted(path for path, about in details.items() if about["type"] == "file")
        if not found:
            raise OptionError(f"{name}: expected files, found none")
        chain = os.fspath(name).partition("::")[2]
        for path in found:
            own = system.unstrip_protocol(path) + (f"::{chain}" if chain else "")
            yield own, int(details[path]["size"] or 0), partial(_fetched, system, path)


def _fetched(system: Any, path: str) -> bytes:
    return bytes(system.cat_file(path))


def _count_of(folder: Path) -> int | None:
    """How many shards a folder has, where it has shards of one division."""
    counts = {path.stem.partition("-of-")[2] for kind in ("shards/*.json", "*.journal") for path in folder.glob(kind)}
    return int(counts.pop()) if len(counts) == 1 and all(count.isdecimal() for count in counts) else None


def _count_for(files: Sequence[_SlicedFile]) -> int:
    """How many shards files make: it depends on nothing but them, so that another call finds the same."""

    def size(file: _SlicedFile) -> int:
        if isinstance(file[1], int):
            return file[1]
        try:
            return os.stat(file[0]).st_size
        except OSError:
            return 0

    total = sum(map(size, files))
    return max(total // _SHARD_BYTES, min(64, total // _SMALL_SHARD_BYTES)) + 1


def _batch_shard(
    build: str, here: str | None, one: _Slice, files: Sequence[_SlicedFile], folder: Path, options: Mapping[str, Any]
) -> tuple[int, int, int]:
    _check_build(build)
    if here is not None and os.getcwd() != here:
        raise OptionError(
            f"files: expected workers in {here}, found one in {os.getcwd()}\nhint: name the files by absolute paths, or start the workers there"
        )
    return _run_slice(one, files, folder, **options)


def _sweep_shard(build: str, protocol: Any, folder: Path, shard: str, restart: bool) -> tuple[int, int, int]:
    _check_build(build)
    runs, refused = palpate.sweep(protocol, folder, shard=shard, restart=restart, threads=1)
    return runs, runs, refused


def _check_build(build: str) -> None:
    if build != _BUILD:
        raise OptionError(f"expected the same build of palpate everywhere, found {palpate.__version__} of another one on this worker")


@contextmanager
def _connected(client: Client | None) -> Iterator[Client]:
    """The client, that at hand, or one of a cluster of this machine."""
    try:
        import distributed
    except ImportError:
        raise OptionError("expected distributed, found none\nhint: pip install palpate[dask]") from None
    if client is None:
        try:
            client = distributed.default_client()
        except ValueError:
            processors = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
            cluster = distributed.LocalCluster(n_workers=processors, threads_per_worker=1, dashboard_address=":0")
            with cluster, distributed.Client(cluster) as own:
                yield own
            return
    if client.asynchronous:
        raise OptionError("client: expected one that waits for results, found one with asynchronous=True")
    yield client


def _check_workers(client: Client) -> None:
    """Refuses workers without palpate, or with another build of it, before anything is computed."""

    # A nested function travels as its code: a worker that lacks palpate can run it.
    def build() -> str | None:
        try:
            from palpate._palpate import _BUILD as found
        except ImportError:
            return None
        return found

    builds: dict[str, Any] = client.run(build, on_error="return")  # pyright: ignore[reportAssignmentType]
    without = sorted(worker for worker, found in builds.items() if found is None)
    if without:
        raise OptionError(f"expected palpate on every worker, found none on {_listed(without)}\nhint: install palpate {palpate.__version__} there")
    # A worker that has just ended gives an error; the one in its place is heard with its first shard.
    others = sorted(worker for worker, found in builds.items() if isinstance(found, str) and found != _BUILD)
    if others:
        raise OptionError(
            f"expected the same build of palpate everywhere, found another one on {_listed(others)}\nhint: install palpate {palpate.__version__} there"
        )


def _listed(names: Sequence[str], most: int = 5) -> str:
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def _driven(
    client: Client | None,
    tasks: Iterator[tuple[str, Callable[[], tuple[int, int, int]]]],
    count: int,
    folder: Path,
    progress: bool | None,
) -> Shards:
    """Runs all tasks, a bounded number of them with the scheduler at a time; one that fails stops no other."""
    with _connected(client) as client, _progress.bar(progress, count, "shard") as tell:
        from distributed import KilledWorker, as_completed

        _check_workers(client)
        running: dict[Future, tuple[str, Callable[[], tuple[int, int, int]], int]] = {}
        completed = as_completed()

        def submit(shard: str, work: Callable[[], tuple[int, int, int]], tries: int) -> None:
            future = client.submit(work, pure=False, key=f"palpate-{shard}-{os.urandom(4).hex()}")
            running[future] = (shard, work, tries)
            completed.add(future)

        def fill() -> None:
            threads: dict[str, int] = client.nthreads()  # pyright: ignore[reportAssignmentType]
            window = 2 * max(1, sum(threads.values())) + 8
            while len(running) < window and (task := next(tasks, None)) is not None:
                submit(*task, 1)

        rows = tests = failed = done = 0
        refused: list[str] = []
        try:
            fill()
            for future in completed:
                shard, work, tries = running.pop(future)
                error = future.exception() if future.status != "cancelled" else PalpateError("the scheduler gave it up")
                if isinstance(error, KilledWorker) and tries < _TRIES:
                    submit(shard, work, tries + 1)
                    continue
                if error is not None:
                    refused.append(f"{shard}: {str(error) or type(error).__name__}")
                else:
                    own = future.result()
                    rows, tests, failed = rows + own[0], tests + own[1], failed + own[2]
                done += 1
                if tell is not None:
                    tell(done)
                fill()
        finally:
            client.cancel(list(running))
    if refused:
        reasons = "\n".join(f"  {reason}" for reason in refused[:10]) + (f"\n  and {len(refused) - 10} more" if len(refused) > 10 else "")
        raise PalpateError(f"{len(refused)} of {count} shards could not be finished:\n{reasons}\nhint: the others are; another call goes on with these")
    return Shards(folder, count, rows, tests, failed)
