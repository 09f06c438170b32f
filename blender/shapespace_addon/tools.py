"""Runs the command-line tools as processes of their own."""

import json
import os
import shutil
import subprocess
import tempfile
import threading

from . import commands, skinned_gltf
from .files import read_shapes, write_ply
from .problem import Problem
from .task import Result

# Meshes from modelling often have non-manifold edges, such as those of inner faces.
_ALWAYS = ("--allow_nonmanifold", "--progress", "lines")
_SECONDS_TO_END = 2  # that a process is given to end by itself
_TO_GET_THEM = "unpack the tools for Windows" if os.name == "nt" else "build shapespace"
_NO_WINDOW = getattr(subprocess, "CREATE_NO_WINDOW", 0)  # of a console, on Windows


def find(folder: str) -> dict:
    """The programs, from a folder or, if that is "", from PATH. Raises Problem."""
    names = commands.NEEDED + commands.OPTIONAL
    found = {name: shutil.which(name, path=folder or None) for name in names}
    missing = [name for name in commands.NEEDED if found[name] is None]
    if missing:
        raise Problem(
            f"{missing[0]} was not found in {folder or 'any folder of PATH'}: {_TO_GET_THEM}, and"
            " name the folder of its tools in the preferences of this add-on"
        )
    return found


def _name(program: str) -> str:
    """As it calls itself: without folder, and without the .exe of Windows."""
    return os.path.splitext(os.path.basename(program))[0]


class ToolsRun:
    """Commands one after the other, in a temporary folder that is gone when the run is over."""

    def __init__(self, task, programs: dict, temporary: str):
        self.share = None
        self.text = ""
        self._body = task.poses
        self._notes = []
        self._errors = []
        self._process = None
        self._folder = tempfile.TemporaryDirectory(prefix="shapespace-", dir=temporary)
        self._names = {commands.SOURCE: "the source's motion"}  # of files, as a person knows them
        try:
            poses = self._write(task.poses, "pose")
            targets = [
                self._write(body, f"target{i}-")[0]
                for i, body in enumerate(getattr(task, "targets", []))
            ]
            self._commands = commands.commands(task, poses, targets, programs, self._folder.name)
            self._done = 0
            self._outputs = commands.outputs(task)
            self._start()
        except BaseException:
            self._folder.cleanup()
            raise

    def poll(self) -> bool:
        """Whether the run is over. Raises Problem if it failed."""
        if self._reader.is_alive():
            return False
        if self._process.wait() != 0:
            self._folder.cleanup()
            program = _name(self._commands[self._done][0])
            said = "; ".join(self._errors) or f"ended with code {self._process.returncode}"
            raise Problem(f"{program}: {said}")
        self._done += 1
        if self._done < len(self._commands):
            self._start()
            return False
        return True

    def cancel(self) -> None:
        """Ends the process and removes the files."""
        self._process.terminate()
        try:
            self._process.wait(_SECONDS_TO_END)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._reader.join()
        self._folder.cleanup()

    def result(self) -> Result:
        try:
            files = [os.path.join(self._folder.name, name) for name in self._outputs]
            motions = [self._read_motion(file) for file in files]
            return Result(motions, list(dict.fromkeys(self._notes)), self._report())
        finally:
            self._folder.cleanup()

    def _read_motion(self, file: str):
        if file.endswith(".glb"):
            return skinned_gltf.read(file, self._body.topology.vertices, len(self._body.shapes))
        return read_shapes(file)

    def _report(self) -> dict:
        """What the tool has written, if it writes one."""
        file = os.path.join(self._folder.name, commands.REPORT)
        if not os.path.exists(file):
            return {}
        with open(file, encoding="utf-8") as source:
            return json.load(source)

    def _write(self, body, prefix: str) -> list:
        files = [f"{prefix}{i}.ply" for i in range(len(body.shapes))]
        for file, name, shape in zip(files, body.names, body.shapes):
            write_ply(os.path.join(self._folder.name, file), shape, body.topology)
            self._names[file] = f"'{name}'"
        return files

    def _start(self) -> None:
        command = self._commands[self._done]
        try:
            self._process = subprocess.Popen(
                [*command, *_ALWAYS],
                cwd=self._folder.name,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                encoding="utf-8",
                errors="replace",
                creationflags=_NO_WINDOW,
            )
        except OSError as error:
            raise Problem(f"{command[0]} cannot be run: {error.strerror}") from None
        self._reader = threading.Thread(target=self._read, args=[self._process], daemon=True)
        self._reader.start()

    def _read(self, process) -> None:
        program = _name(process.args[0])
        with process.stdout:
            for line in process.stdout:
                self._hear(program, line.rstrip("\n"))

    def _hear(self, program: str, line: str) -> None:
        kind, _, rest = line.partition(" ")
        if kind == "progress":
            share, _, self.text = rest.partition(" ")
            if share != "-":
                self.share = (self._done + float(share)) / len(self._commands)
            return
        for file, name in self._names.items():
            rest = rest.replace(file, name)
        if kind in (f"{program}:", "ERROR:"):
            self._errors.append(rest)
        elif kind == "warning:":
            self._notes.append(rest)
        elif "NOT CONVERGED" in line or "STOPPED EARLY" in line:
            self._notes.append(line)
