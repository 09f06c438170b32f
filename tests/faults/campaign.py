#!/usr/bin/env python3
r"""Runs the tools while something goes wrong, and says what became of their files.

    tests/faults/campaign.py FOLDER [--times N] [--only FAULT,...] [--tools TOOL,...] [--seed S]

FOLDER has the programs. Inputs are made by shape-body in a temporary folder. Each tool is first run
undisturbed; what it writes then is what it is to write under every fault, or nothing. A run ends
well if each of its files is complete, or is what stood there before; if the inputs are as before;
if no temporary file is left; and if the exit code is right: 0 if all is done, 1 with a message that
names the file if not, and after a signal that signal. Only SIGKILL may leave temporary files. The
table counts how runs ended; those that ended otherwise are findings, each of which is printed when
it is found, and the exit code is 1 if there are any.

A short one, of less than a minute:

    tests/faults/campaign.py FOLDER --times 1 --tools body,explore,interpolate \
        --only signals,disk,size,stdout,readonly,inputs,two,records,ranks

What needs root (a small disk, another user), strace (errors of single system calls) or mpirun is
left out, with a line that says so, where this is missing.
"""

import argparse
import collections
import filecmp
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

HANG = 60  # seconds
OLD = b"an older file\n"
TEMPORARY = re.compile(r"\.part[0-9a-f]{16}$")
NOBODY = 65534
UNREADABLE = ()  # names of a message that could not be printed


def content(file):
    with open(file, "rb") as opened:
        return opened.read()


def write(file, data):
    os.makedirs(os.path.dirname(file), exist_ok=True)
    with open(file, "wb") as opened:
        opened.write(data)


def files_below(folder):
    found = {}
    for root, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(root, name)
            found[os.path.relpath(path, folder)] = path
    return found


class Job:
    """One call of a tool. Outputs are named out/..., inputs in/..., beside each other."""

    def __init__(self, name, tool, arguments, keeps_records=False, path=None):
        self.name = name
        self.tool = tool
        self.arguments = arguments
        self.keeps_records = keeps_records  # finished geodesics stay when a run is ended
        self.path = path  # that is written, as far as it goes, after Ctrl-C
        self.expected = {}  # content by name, of the undisturbed run
        self.varying = set()  # of these outputs, those that contain times
        self.seconds = 0.0

    def inputs(self):
        names = re.findall(r"in/[\w.]+", " ".join(self.arguments))
        return sorted(set(names))

    def outputs(self):
        """Names of which one is in a message: of the files, and as on the command line."""
        return ["out/" + name for name in self.expected] + re.findall(r"out/[\w.%]+",
                                                                      " ".join(self.arguments))


class Outcome:
    def __init__(self, code, out, err, hung):
        self.code = code  # negative: the signal
        self.out = out
        self.err = err
        self.hung = hung


class Campaign:
    def __init__(self, tools, options, folder):
        self.tools = os.path.abspath(tools)
        self.options = options
        self.folder = folder
        self.random = random.Random(options.seed)
        self.table = collections.OrderedDict()  # (fault, job): Counter
        self.findings = []
        self.left_out = []
        self.jobs = []

    # Running.

    def program(self, tool):
        return os.path.join(self.tools, tool)

    def start(self, job, folder, out=subprocess.PIPE, err=subprocess.PIPE, prefix=(),
              preexec=None, stdin=subprocess.DEVNULL):
        command = list(prefix) + [self.program(job.tool)] + job.arguments

        def prepare():
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            if preexec:
                preexec()

        return subprocess.Popen(command, cwd=folder, stdin=stdin, stdout=out, stderr=err,
                                preexec_fn=prepare)

    def finish(self, process):
        try:
            out, err = process.communicate(timeout=HANG)
            hung = False
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            hung = True
        return Outcome(process.returncode, (out or b"").decode(errors="replace"),
                       (err or b"").decode(errors="replace"), hung)

    def run(self, job, folder, **how):
        return self.finish(self.start(job, folder, **how))

    def fresh(self, job, with_old=False, base=None):
        """The folder of a run, with the inputs and an empty out/, or one with older files."""
        folder = os.path.join(base or self.folder, "run")
        if os.path.isdir(folder):
            for root, _, _ in os.walk(folder):
                os.chmod(root, 0o755)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(os.path.join(folder, "out"))
        os.makedirs(os.path.join(folder, "in"))
        for name in job.inputs():
            shutil.copyfile(os.path.join(self.folder, name), os.path.join(folder, name))
        if with_old:
            for name in job.expected:
                write(os.path.join(folder, "out", name), OLD)
        return folder

    # Judging.

    def is_complete(self, job, name, data):
        if data == job.expected[name]:
            return True
        if name not in job.varying:
            return False
        try:
            json.loads(data)
            return True
        except ValueError:
            return False

    def is_path(self, file):
        return subprocess.run([self.program("shape-inspect"), file], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, check=False).returncode == 0

    def judge(self, fault, job, folder, outcome, with_old=False, ended_by=None, inputs_changed=(),
              may_leave_temporaries=False, must_fail=False, other_results=(), names=None):
        """Counts how a run ended, and notes it if that is a finding. A message must contain one of
        `names`, by default those of the inputs, outputs and records.
        """
        wrong = []
        complete, before, unknown = [], [], []
        out = os.path.join(folder, "out")
        present = files_below(out)
        for name in job.expected:
            if name not in present:
                (unknown if with_old else before).append(name)
                continue
            data = content(present[name])
            if with_old and data == OLD:
                before.append(name)
            elif self.is_complete(job, name, data):
                complete.append(name)
            elif any(data == other.get(name) for other in other_results):
                complete.append(name)
            elif (ended_by in (signal.SIGINT, signal.SIGTERM) and name == job.path and
                  self.is_path(present[name])):
                complete.append(name)
            else:
                unknown.append(name)
        for name in unknown:
            wrong.append("half-written or wrong: " + name)
        for name in sorted(set(present) - set(job.expected)):
            if job.keeps_records and ".records/" in name and outcome.code != 0:
                if TEMPORARY.search(name) and not may_leave_temporaries:
                    wrong.append("temporary left: " + name)
            elif not (TEMPORARY.search(name) and may_leave_temporaries):
                wrong.append("left behind: " + name)
        for name in job.inputs():
            if name not in inputs_changed and not filecmp.cmp(
                    os.path.join(folder, name), os.path.join(self.folder, name), shallow=False):
                wrong.append("input changed: " + name)
        code = outcome.code
        if outcome.hung:
            wrong.append("hung")
        elif ended_by is not None and code == -ended_by:
            pass
        elif code < 0:
            wrong.append("ended by signal %d" % -code)
        elif code == 0:
            if before:
                wrong.append("exit code 0 without " + before[0])
            if must_fail:
                wrong.append("exit code 0")
        elif code != 1:
            wrong.append("exit code %d" % code)
        elif ended_by is not None:
            wrong.append("exit code 1")
        elif names is not UNREADABLE:
            if names is None:
                names = job.inputs() + job.outputs() + [".records"]
            said = outcome.err + outcome.out  # shape-inspect's findings are results
            if not any(name in said for name in names):
                wrong.append("the message names no file")
        if not before and not unknown:
            ending = "complete"
        elif not complete and not unknown:
            ending = "as before"
        else:
            ending = "some complete"
        self.count(fault, job.name, ending, code, wrong, outcome)

    def count(self, fault, name, ending, code, wrong, outcome):
        counter = self.table.setdefault((fault, name), collections.Counter())
        counter["runs"] += 1
        counter[ending] += 1
        counter["exit 0" if code == 0 else "exit 1" if code == 1 else "signal" if code < 0 else
                "other code"] += 1
        if wrong:
            counter["findings"] += 1
            said = outcome.err.strip().splitlines()
            finding = (fault, name, "; ".join(wrong), said[-1] if said else "")
            print("FINDING: %s: %s: %s (%s)" % finding, file=sys.stderr, flush=True)
            self.findings.append(finding)

    # Inputs.

    def body(self, *arguments):
        subprocess.run([self.program("shape-body"), *arguments], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL)

    def tool(self, *arguments):
        subprocess.run([self.program(arguments[0]), *arguments[1:]], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def make_inputs(self):
        os.makedirs(os.path.join(self.folder, "in"))
        self.body("tube", "--triangles", "300", "--at", "0,30,60,90", "--output", "in/t%d.obj")
        self.body("tube", "--triangles", "300", "--at", "20", "--output", "in/other%d.ply")
        self.tool("shape-interpolate", "in/t0.obj", "in/t2.obj", "--shapes", "3", "--output",
                  "in/walk.path")
        self.tool("shape-explore", "in/t0.obj", "in/t1.obj", "in/t2.obj", "--depth", "0",
                  "--output", "in/poses.space")
        self.tool("shape-statistics", "in/t0.obj", "in/t1.obj", "in/t2.obj", "in/t3.obj",
                  "--output", "in/herd.modes")
        handles = {"handles": [{"fixed": True, "select": {"vertices": [[1, 20]]}},
                               {"translation": [0, 0.2, 0],
                                "select": {"vertices": [100, 101, 102]}}]}
        write(os.path.join(self.folder, "in/handles.json"), json.dumps(handles).encode())
        write(os.path.join(self.folder, "in/curve.json"), b'{"points": ["t0", "t2", "t1"]}')
        markers = "".join("%d %d\n" % (k, k) for k in range(1, 152, 10))
        write(os.path.join(self.folder, "in/markers.txt"), markers.encode())

    def make_jobs(self):
        poses = ["in/t0.obj", "in/t1.obj", "in/t2.obj", "in/t3.obj"]
        # A page needs a viewer that was built in.
        page = os.path.join(self.folder, "page.html")
        has_page = subprocess.run(
            [self.program("shape-view"), os.path.join(self.folder, "in/walk.path"), "--output",
             page], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False
        ).returncode == 0
        html = lambda name: "," + name if has_page else ""
        jobs = [
            Job("body", "shape-body",
                ["quadruped", "--random", "4", "--triangles", "1500", "--output", "out/b%d.obj",
                 "--table", "out/b.csv"]),
            Job("average", "shape-average",
                poses[:3] + ["--output", "out/m.obj,out/m.png,out/m.pc2"]),
            Job("correspond", "shape-correspond",
                ["in/t0.obj", "in/other0.ply", "--markers", "in/markers.txt", "--output",
                 "out/f.obj,out/map.txt,out/check.png", "--report", "out/r.json"]),
            Job("deform", "shape-deform",
                ["in/t0.obj", "--handles", "in/handles.json", "--output",
                 "out/d.path,out/d%d.ply,out/d.glb,out/d.png"], path="d.path"),
            Job("explore", "shape-explore",
                poses + ["--depth", "2", "--threshold", "0.01%", "--output", "out/p.space",
                         "--report", "out/r.json"], keeps_records=True),
            Job("explore csv", "shape-explore", poses + ["--output", "out/d.csv"],
                keeps_records=True),
            Job("explore walk", "shape-explore",
                ["--sample", "in/curve.json", "in/poses.space", "--frames", "9", "--output",
                 "out/w.glb,out/w%d.obj"]),
            Job("export", "shape-export",
                ["in/walk.path", "--frames", "12", "--output",
                 "out/e%02d.obj,out/e%02d.stl,out/e.usda,out/e.mdd,out/e.glb,out/e.png" +
                 html("out/e.html")]),
            Job("extrapolate", "shape-extrapolate",
                ["in/walk.path", "--steps", "4", "--output", "out/x.path,out/x%d.vtp,out/x.png"],
                path="x.path"),
            Job("inspect", "shape-inspect", ["in/t0.obj", "in/t1.obj", "in/walk.path"]),
            Job("interpolate", "shape-interpolate",
                ["in/t0.obj", "in/t2.obj", "--shapes", "7", "--output",
                 "out/w.path,out/w.png,out/w%d.off", "--report", "out/r.json"], path="w.path"),
            Job("statistics", "shape-statistics",
                poses + ["--output", "out/h.modes,out/h.png,out/h%d.glb,out/h.csv,out/h.pc2" +
                         html("out/h.html")]),
            Job("transfer", "shape-transfer",
                ["in/walk.path", "--target", "in/other0.ply", "--output", "out/t.path,out/t%d.obj",
                 "--hybrids", "out/h.glb"], path="t.path"),
            Job("transport", "shape-transport",
                ["in/walk.path", "in/other0.ply", "--output", "out/c.obj,out/c.png", "--tangents",
                 "out/c.csv"]),
        ]
        if has_page:
            jobs.append(Job("view", "shape-view", ["in/walk.path", "--output", "out/v.html"]))
        else:
            self.left_out.append("shape-view: these tools were built without the viewer")
        if self.options.tools:
            jobs = [job for job in jobs if job.name in self.options.tools]
        for job in jobs:
            runs = []
            for _ in range(3):
                folder = self.fresh(job)
                begin = time.monotonic()
                outcome = self.run(job, folder)
                job.seconds = time.monotonic() - begin
                if outcome.code != 0:
                    raise SystemExit("%s fails undisturbed: %s" % (job.name, outcome.err))
                runs.append({name: content(path)
                             for name, path in files_below(os.path.join(folder, "out")).items()})
            job.expected = runs[0]
            job.out = outcome.out
            for name, data in runs[0].items():
                if any(run[name] != data for run in runs):
                    if not name.endswith(".json"):
                        raise SystemExit("%s: %s differs from run to run" % (job.name, name))
                    job.varying.add(name)
        self.jobs = jobs

    def times(self, most=None):
        count = self.options.times
        return range(count if most is None else min(count, most))

    # Faults.

    def signals(self):
        for job in self.jobs:
            for number, name in ((signal.SIGINT, "SIGINT"), (signal.SIGTERM, "SIGTERM"),
                                 (signal.SIGKILL, "SIGKILL")):
                for i in self.times():
                    folder = self.fresh(job, with_old=i % 2 == 1)
                    process = self.start(job, folder)
                    time.sleep(self.random.uniform(0, 1.1) * job.seconds)
                    process.send_signal(number)
                    outcome = self.finish(process)
                    self.judge(name, job, folder, outcome, with_old=i % 2 == 1, ended_by=number,
                               may_leave_temporaries=number == signal.SIGKILL)
                    if job.keeps_records and number == signal.SIGKILL:
                        # The next run takes what there is and comes to the same end.
                        outcome = self.run(job, folder)
                        self.judge("after SIGKILL", job, folder, outcome)

    def full_disk(self):
        disk = os.path.join(self.folder, "disk")
        os.makedirs(disk)
        for job in self.jobs:
            if not job.expected:
                continue
            total = sum((len(data) + 4095) // 4096 * 4096 for data in job.expected.values())
            for i in self.times():
                size = int(self.random.uniform(0, 0.95) * total) // 4096 * 4096
                folder = self.fresh(job)
                out = os.path.join(folder, "out")
                mounted = subprocess.run(
                    ["mount", "-t", "tmpfs", "-o", "size=%d" % max(size, 4096), "none", out],
                    stderr=subprocess.DEVNULL, check=False).returncode == 0
                if not mounted:
                    self.left_out.append("a full disk: no small disk can be mounted (needs root)")
                    return
                try:
                    outcome = self.run(job, folder)
                    self.judge("full disk", job, folder, outcome, must_fail=True)
                finally:
                    subprocess.run(["umount", out], check=True)

    def limited_size(self):
        for job in self.jobs:
            if not job.expected:
                continue
            largest = max(len(data) for data in job.expected.values())
            for i in self.times():
                size = int(self.random.uniform(0, 0.95) * largest)
                with_old = i % 2 == 1
                folder = self.fresh(job, with_old)
                limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
                outcome = self.run(job, folder, preexec=limit)
                self.judge("limited file size", job, folder, outcome, with_old, must_fail=True)

    def full_stdout(self):
        for job in self.jobs:
            for arguments in (job.arguments, ["--help"], ["--version"]):
                other = Job(job.name, job.tool, arguments, job.keeps_records)
                other.expected = job.expected if arguments is job.arguments else {}
                other.varying = job.varying
                folder = self.fresh(other)
                with open("/dev/full", "wb") as full:
                    outcome = self.run(other, folder, out=full)
                if arguments is job.arguments and not job.out:
                    continue
                self.judge("full stdout", other, folder, outcome, must_fail=True, names=["stdout"])

    def closed_streams(self):
        for job in self.jobs:
            for closed in ((0,), (1,), (2,), (0, 1, 2)):
                folder = self.fresh(job)
                outcome = self.run(job, folder, out=subprocess.DEVNULL, err=subprocess.DEVNULL,
                                   preexec=lambda: [os.close(stream) for stream in closed])
                self.judge("closed streams", job, folder, outcome, names=UNREADABLE,
                           must_fail=1 in closed and bool(job.out))

    def read_only(self):
        root = os.getuid() == 0

        def become_nobody():
            if root:
                os.setgid(NOBODY)
                os.setuid(NOBODY)

        base = tempfile.mkdtemp(prefix="shapespace-faults-")
        try:
            os.chmod(base, 0o755)
            for job in self.jobs:
                if not job.expected:
                    continue
                folder = self.fresh(job, base=base)
                os.chmod(os.path.join(folder, "out"), 0o555)
                outcome = self.run(job, folder, preexec=become_nobody)
                self.judge("read-only folder", job, folder, outcome, must_fail=True,
                           names=job.outputs())
                # An input that may not be read.
                for name in job.inputs():
                    folder = self.fresh(job, base=base)
                    os.chmod(os.path.join(folder, "out"), 0o777)
                    os.chmod(os.path.join(folder, name), 0)
                    outcome = self.run(job, folder, preexec=become_nobody)
                    self.judge("unreadable input", job, folder, outcome, must_fail=True,
                               names=[name])
        except (PermissionError, subprocess.SubprocessError) as error:  # where the tools lie
            self.left_out.append("read-only folders: another user cannot run the tools: %s" % error)
        finally:
            shutil.rmtree(base, ignore_errors=True)

    def changing_inputs(self):
        for job in self.jobs:
            if not job.inputs():
                continue
            for i in self.times():
                for how in ("grows", "shrinks", "is replaced"):
                    name = self.random.choice(job.inputs())
                    folder = self.fresh(job)
                    file = os.path.join(folder, name)
                    data = content(file)
                    if how == "grows":
                        final = data + data
                    elif how == "shrinks":
                        final = data[:self.random.randrange(len(data))]
                    else:
                        final = content(os.path.join(self.folder, "in/t3.obj"))
                        if not name.endswith(".obj"):
                            final = data[: len(data) // 2]
                    # What a run writes that finds the file so from the beginning.
                    write(file, final)
                    outcome = self.run(job, folder)
                    other = {n: content(p) for n, p in
                             files_below(os.path.join(folder, "out")).items()}
                    folder = self.fresh(job)
                    process = self.start(job, folder)
                    time.sleep(self.random.uniform(0, 0.3) * job.seconds)
                    if how == "grows":
                        with open(file, "ab", buffering=0) as opened:
                            step = max(1, len(data) // 50)
                            for at in range(0, len(data), step):
                                opened.write(data[at:at + step])
                    elif how == "shrinks":
                        os.truncate(file, len(final))
                    else:
                        write(file + ".new", final)
                        os.rename(file + ".new", file)
                    outcome = self.finish(process)
                    if outcome.code == 2:  # a mesh that cannot have this option, for example
                        outcome.code = 1
                    self.judge("input " + how, job, folder, outcome, inputs_changed=[name],
                               other_results=[other])

    def two_runs(self):
        for job in self.jobs:
            if not job.keeps_records:
                continue
            for _ in self.times():
                folder = self.fresh(job)
                first = self.start(job, folder)
                time.sleep(self.random.uniform(0, 1) * job.seconds)
                second = self.start(job, folder)
                for process in (first, second):
                    outcome = self.finish(process)
                    wrong = [] if outcome.code == 0 else ["exit code %d" % outcome.code]
                    self.count("two runs at once", job.name, "complete" if not wrong else
                               "some complete", outcome.code, wrong, outcome)
                self.judge("after two runs", job, folder, Outcome(0, "", "", False))

    def records_of(self, job):
        """The records that a run of this job makes, by name, and the name of their folder."""
        output = next(a for a in job.arguments if a.startswith("out/"))
        folder = self.fresh(job)
        records = os.path.join(folder, output) + ".records"
        process = self.start(job, folder)
        while process.poll() is None and not os.path.isdir(records):
            pass
        # A folder stands where the output is to be, which therefore fails, and the records stay.
        os.makedirs(os.path.join(folder, output, "x"), exist_ok=True)
        self.finish(process)
        found = {name: content(path) for name, path in files_below(records).items()}
        return os.path.basename(records), found

    def damaged_records(self):
        for job in self.jobs:
            if not job.keeps_records:
                continue
            records, found = self.records_of(job)
            if not found:
                self.left_out.append("damaged records of %s: no records could be kept" % job.name)
                continue
            longest = max(len(data) for data in found.values())
            places = list(range(min(longest, 200)))
            rest = list(range(len(places), longest))
            self.random.shuffle(rest)
            places += rest
            if self.options.times < 200:
                self.random.shuffle(places)
                places = places[:self.options.times]
            elif len(places) > 2000:
                places = places[:2000]
            for place in places:
                folder = self.fresh(job)
                hurt = 0
                for name, data in found.items():
                    if place < len(data):
                        hurt += 1
                        changed = bytearray(data)
                        changed[place] ^= 1 << self.random.randrange(8)
                        data = bytes(changed)
                    write(os.path.join(folder, "out", records, name), data)
                outcome = self.run(job, folder)
                self.judge("damaged records", job, folder, outcome)
                if "--report" in job.arguments and (
                        "%d of its records were damaged" % hurt not in outcome.err):
                    self.count("damaged records", job.name, "complete", outcome.code,
                               ["byte %d: damage of %d records was not told" % (place, hurt)],
                               outcome)
            for what, change in (("cut off", lambda data, k: data[:k]),
                                 ("longer", lambda data, k: data + data[:k + 1]),
                                 ("of another", None)):
                for i in self.times(20):
                    folder = self.fresh(job)
                    names = sorted(found)
                    for k, name in enumerate(names):
                        data = found[names[(k + 1 + i) % len(names)]] if change is None else \
                            change(found[name], self.random.randrange(len(found[name])))
                        write(os.path.join(folder, "out", records, name), data)
                    self.judge("records " + what, job, folder, self.run(job, folder))

    def clock(self):
        faketime = shutil.which("faketime")
        for job in self.jobs:
            for when in (0, 1, 2 ** 31 - 1, 2 ** 32 + 5):
                folder = self.fresh(job, with_old=True)
                for path in files_below(folder).values():
                    os.utime(path, (when, when))
                self.judge("times of files", job, folder, self.run(job, folder), with_old=True)
            if faketime:
                for offset in ("-10y", "+50y", "-5s x0.1"):
                    folder = self.fresh(job, with_old=True)
                    outcome = self.run(job, folder, prefix=[faketime, "-f", offset])
                    self.judge("clock set", job, folder, outcome, with_old=True)
        if not faketime:
            self.left_out.append("a clock that is set: there is no faketime")

    def failing_calls(self):
        """Errors of single system calls, as of a disk or a network that fails."""
        strace = shutil.which("strace")
        if not strace or subprocess.run([strace, "-f", "-o", "/dev/null", "true"],
                                        stderr=subprocess.DEVNULL, check=False).returncode != 0:
            self.left_out.append("failing system calls: strace cannot trace here")
            return
        faults = [("write: ENOSPC", "write", "error=ENOSPC", "+"),
                  ("write: EIO once", "write", "error=EIO", ""),
                  ("rename: EIO", "rename,renameat,renameat2", "error=EIO", ""),
                  ("read: EIO", "read,readv", "error=EIO", "+"),
                  ("open: EMFILE", "openat", "error=EMFILE", "+"),
                  ("slow rename", "rename,renameat,renameat2", "delay_enter=200000", "")]
        traced = os.path.join(self.folder, "trace")
        for job in self.jobs:
            for fault, calls, what, on in faults:
                # Where the calls are that concern this run's own files.
                folder = self.fresh(job)
                self.run(job, folder, prefix=[strace, "-f", "-y", "-o", traced, "-e",
                                              "trace=" + calls])
                lines = [line for line in content(traced).decode(errors="replace").splitlines()
                         if re.search(r"^\d+ +(%s)\(" % calls.replace(",", "|"), line)]
                first = next((k for k, line in enumerate(lines)
                              if '"in/' in line or '"out/' in line or "/run/" in line), None)
                if first is None:
                    continue
                for i in self.times(10):
                    at = self.random.randint(first + 1, len(lines))
                    folder = self.fresh(job, with_old=i % 2 == 1)
                    prefix = [strace, "-f", "-o", "/dev/null", "-e", "trace=" + calls, "-e",
                              "inject=%s:%s:when=%d%s" % (calls, what, at, on)]
                    if fault == "slow rename" and i % 2 == 0:
                        prefix[-1] = "inject=%s:%s" % (calls, what)
                        process = self.start(job, folder, prefix=prefix)
                        time.sleep(self.random.uniform(0.3, 1.5) * (job.seconds + 0.3))
                        tools = children(process.pid)
                        for child in tools:
                            os.kill(child, signal.SIGINT)
                        self.judge("slow rename, SIGINT", job, folder, self.finish(process),
                                   ended_by=signal.SIGINT)
                        continue
                    outcome = self.run(job, folder, prefix=prefix)
                    # What fails may as well be stdout, or the message.
                    self.judge(fault, job, folder, outcome, with_old=i % 2 == 1,
                               names=UNREADABLE if calls == "write" else None)

    def ranks(self):
        job = next((job for job in self.jobs if job.name == "explore"), None)
        mpirun = shutil.which("mpirun")
        if not mpirun or job is None:
            self.left_out.append("killed ranks: there is no mpirun")
            return
        environment = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        os.environ.update(environment)
        prefix = [mpirun, "--oversubscribe", "-n", "3"]
        folder = self.fresh(job)
        begin = time.monotonic()
        outcome = self.run(job, folder, prefix=prefix)
        seconds = time.monotonic() - begin
        if "built without MPI" in outcome.err or outcome.code != 0:
            self.left_out.append("killed ranks: " + outcome.err.strip()[:100])
            return
        for _ in self.times(60):
            folder = self.fresh(job)
            process = self.start(job, folder, prefix=prefix)
            time.sleep(self.random.uniform(0.1, 1) * seconds)
            ranks = [pid for pid in children(process.pid) if name_of(pid) == "shape-explore"]
            if ranks:
                try:
                    os.kill(self.random.choice(ranks), signal.SIGKILL)
                except ProcessLookupError:
                    pass
            outcome = self.finish(process)
            if outcome.code not in (0, 1) and outcome.code > 0:
                outcome.code = 1  # mpirun's own, such as 137
            self.judge("killed rank", job, folder, outcome, may_leave_temporaries=True,
                       names=UNREADABLE)
            self.judge("after a killed rank", job, folder, self.run(job, folder))

    def report(self):
        columns = ("runs", "complete", "some complete", "as before", "exit 0", "exit 1", "signal",
                   "findings")
        print("| fault | tool | " + " | ".join(columns) + " |")
        print("|---|---|" + "---:|" * len(columns))
        of_fault = collections.OrderedDict()
        for (fault, name), counter in self.table.items():
            if self.options.by_tool:
                print("| %s | %s | " % (fault, name) +
                      " | ".join(str(counter[column]) for column in columns) + " |")
            total, tools = of_fault.setdefault(fault, (collections.Counter(), set()))
            total.update(counter)
            tools.add(name)
        for fault, (counter, tools) in of_fault.items():
            name = next(iter(tools)) if len(tools) == 1 else "%d calls" % len(tools)
            print("| %s | %s | " % (fault, name) +
                  " | ".join(str(counter[column]) for column in columns) + " |")
        for line in self.left_out:
            print("left out: " + line)
        print("findings: %d" % len(self.findings))


def children(pid):
    """All processes below one."""
    found = []
    try:
        for task in os.listdir("/proc/%d/task" % pid):
            with open("/proc/%d/task/%s/children" % (pid, task)) as opened:
                for child in opened.read().split():
                    found += [int(child)] + children(int(child))
    except FileNotFoundError:
        pass
    return found


def name_of(pid):
    try:
        return content("/proc/%d/comm" % pid).decode().strip()
    except FileNotFoundError:
        return ""


def main():
    faults = {"signals": Campaign.signals, "disk": Campaign.full_disk,
              "size": Campaign.limited_size, "stdout": Campaign.full_stdout,
              "closed": Campaign.closed_streams,
              "readonly": Campaign.read_only, "inputs": Campaign.changing_inputs,
              "two": Campaign.two_runs, "records": Campaign.damaged_records,
              "clock": Campaign.clock, "calls": Campaign.failing_calls, "ranks": Campaign.ranks}
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="with the programs shape-body, shape-interpolate, ...")
    parser.add_argument("--times", type=int, default=3, help="runs of each tool under each fault")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=lambda text: text.split(","), default=list(faults),
                        help="faults: " + ", ".join(faults))
    parser.add_argument("--tools", type=lambda text: text.split(","), default=[],
                        help="calls, such as interpolate,explore")
    parser.add_argument("--by_tool", action="store_true", help="a line of the table for each tool")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="shapespace-faults-") as folder:
        os.chmod(folder, 0o755)
        campaign = Campaign(options.folder, options, folder)
        campaign.make_inputs()
        campaign.make_jobs()
        try:
            for name in options.only:
                begin = time.monotonic()
                faults[name](campaign)
                print("%s: %.0f s" % (name, time.monotonic() - begin), file=sys.stderr, flush=True)
        finally:
            campaign.report()
        return 1 if campaign.findings else 0


if __name__ == "__main__":
    sys.exit(main())
