"""Stands in for HyperQueue's program `hq` where only its Python package is to be had (PyPI: hyperqueue).

The server, the workers and all that happens between them are HyperQueue's own; this file but speaks the documented command line:

    hq server start                     in the foreground
    hq worker start [--cpus N]          in the foreground, a process of its own that can be killed
    hq submit --array IDS [--name] [--cpus] [--cwd] [--stdout] [--stderr] -- PROGRAM ...
    hq job wait ID, hq job info ID

The package starts a worker only in the process of a server of its own, but the worker finds its server by the link `hq-current` in a folder: the
link is turned to the server that is meant. The package keeps no journal, so `--journal` is refused rather than passed over: a server that is
started again here has forgotten its jobs.
"""

import argparse
import json
import os
import signal
import sys
import tempfile
from pathlib import Path

from hyperqueue.cluster import LocalCluster, WorkerConfig
from hyperqueue.ffi.client import ClientConnection
from hyperqueue.ffi.protocol import JobDescription, ResourceRequest, TaskDescription
from hyperqueue.output import StdioDef


def server_dir(arguments):
    return Path(arguments.server_dir or Path.home() / ".hq-server")


def server_start(arguments):
    folder = server_dir(arguments)
    folder.mkdir(parents=True, exist_ok=True)
    _cluster = LocalCluster(str(folder))
    # Jobs that a server before it knew are forgotten with it.
    for record in folder.glob("job-*.json"):
        record.unlink()
    print("ready", flush=True)
    signal.pause()


def worker_start(arguments):
    with tempfile.TemporaryDirectory() as own:
        cluster = LocalCluster(own)
        link = Path(own) / "hq-current"
        link.unlink()
        link.symlink_to((server_dir(arguments) / "hq-current").resolve())
        cluster.start_worker(WorkerConfig(cores=arguments.cpus))
        print("ready", flush=True)
        signal.pause()


def ids(selector):
    for part in selector.split(","):
        first, _, last = part.partition("-")
        yield from range(int(first), int(last or first) + 1)


def submit(arguments):
    stdio = lambda path: StdioDef.from_path(path) if path != "none" else None
    tasks = [
        TaskDescription(
            id=number,
            args=arguments.program,
            cwd=arguments.cwd,
            stdout=stdio(arguments.stdout),
            stderr=stdio(arguments.stderr),
            stdin=None,
            env=dict(os.environ),
            dependencies=[],
            task_dir=False,
            priority=0,
            resource_request=[ResourceRequest(cpus=arguments.cpus)],
            crash_limit=None,
        )
        for number in ids(arguments.array)
    ]
    job = ClientConnection(str(server_dir(arguments))).submit_job(JobDescription(arguments.name, tasks, None))
    record = {"id": job, "name": arguments.name, "program": {"args": arguments.program, "cwd": arguments.cwd}}
    (server_dir(arguments) / f"job-{job}.json").write_text(json.dumps(record))
    print(job)


def job_wait(arguments):
    failed = ClientConnection(str(server_dir(arguments))).wait_for_jobs([arguments.id], lambda _: None)
    sys.exit(1 if failed else 0)


def job_info(arguments):
    # Asked for what the server itself must know: an error where it has ended, or has forgotten the job.
    ClientConnection(str(server_dir(arguments))).get_failed_tasks([arguments.id])
    print((server_dir(arguments) / f"job-{arguments.id}.json").read_text())


def command_line():
    top = argparse.ArgumentParser(prog="hq", allow_abbrev=False)
    top.add_argument("--server-dir", default=os.environ.get("HQ_SERVER_DIR"))
    top.add_argument("--output-mode", choices=["cli", "json", "quiet"])
    verbs = top.add_subparsers(required=True)
    server = verbs.add_parser("server").add_subparsers(required=True).add_parser("start")
    server.set_defaults(run=server_start)
    worker = verbs.add_parser("worker").add_subparsers(required=True).add_parser("start")
    worker.add_argument("--cpus", type=int, default=1)
    worker.set_defaults(run=worker_start)
    new = verbs.add_parser("submit", allow_abbrev=False)
    new.add_argument("--name")
    new.add_argument("--array", required=True)
    new.add_argument("--cpus", type=int, default=1)
    new.add_argument("--cwd")
    new.add_argument("--stdout")
    new.add_argument("--stderr")
    new.add_argument("program", nargs="+")
    new.set_defaults(run=submit)
    job = verbs.add_parser("job").add_subparsers(required=True)
    for name, run in [("wait", job_wait), ("info", job_info)]:
        verb = job.add_parser(name)
        verb.add_argument("id", type=int)
        verb.set_defaults(run=run)
    return top.parse_args()


if __name__ == "__main__":
    chosen = command_line()
    try:
        chosen.run(chosen)
    except Exception as error:
        sys.exit(f"hq: {str(error).splitlines()[0]}")
