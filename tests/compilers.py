#!/usr/bin/env python3
"""Whether the results depend on the compiler.

    tests/compilers.py [FOLDER]

Builds the tools with g++ and clang++, each with optimisation and without, in FOLDER
(build/compilers), runs the same commands with each, and prints how far vertices are at most from
where they are with the first build, as a share of the size of the shape. Exit code 1 if that is more
than a millionth. Takes a quarter of an hour on two cores.
"""

import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILDS = [("g++ -O3", ["g++", "-O3 -DNDEBUG"]), ("g++ -O0", ["g++", "-O0"]),
          ("clang++ -O3", ["clang++", "-O3 -DNDEBUG"]), ("clang++ -O0", ["clang++", "-O0"])]

# Commands without the first part of the tools' names. Each writes shapes named out0.obj and so on in
# a folder of its own, above which are the bodies.
BODIES = """
tube --triangles 300 --at 0,45,90 --output tube%d.obj
tube --triangles 300 --at 20 --output other%d.obj
sheet --triangles 400 --output sheet%d.obj
bar --triangles 400 --output bar%d.obj
miura --output miura%d.obj
quadruped --triangles 700 --pose stand,stride,sit --output animal%d.obj
"""
TIGHT = "--tolerance 1e-12 --max_iterations 5000"
COMMANDS = f"""
interpolate ../tube0.obj ../tube2.obj --shapes 5 {TIGHT} --output ../tube.path,out%d.obj
interpolate ../tube0.obj ../tube2.obj --shapes 3 --solver lbfgs {TIGHT} --output out%d.obj
interpolate ../tube0.obj ../tube2.obj --shapes 3 --solver trust_region {TIGHT} --output out%d.obj
interpolate ../sheet0.obj ../sheet1.obj --shapes 5 {TIGHT} --output out%d.obj
interpolate ../bar0.obj ../bar1.obj --shapes 5 {TIGHT} --output out%d.obj
interpolate ../miura0.obj ../miura1.obj --shapes 5 {TIGHT} --output out%d.obj
interpolate ../animal0.obj ../animal1.obj --shapes 5 {TIGHT} --output out%d.obj
interpolate ../animal0.obj ../animal1.obj --shapes 5 --output out%d.obj
interpolate ../animal0.obj ../animal1.obj ../animal2.obj --spline natural --shapes 3 {TIGHT} \
    --output out%d.obj
extrapolate ../tube.path --steps 8 --output out%d.obj
transfer ../tube.path --target ../other0.obj --output out%d.obj
average ../animal0.obj ../animal1.obj ../animal2.obj --output out0.obj
deform ../tube0.obj --handles ../handles.json {TIGHT} --output out%d.obj
"""
HANDLES = {"handles": [{"fixed": True, "select": {"vertices": [[1, 20]]}},
                       {"translation": [0, 0.2, 0], "select": {"vertices": [100, 101, 102]}}]}

ALLOWED = 1e-6


def lines(text):
  return [" ".join(line.split()) for line in text.strip().split("\n")]


def build(folder, compiler, flags):
  configure = ["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
               "-DCMAKE_UNITY_BUILD=ON", "-DSHAPESPACE_BUILD_TESTS=OFF",
               "-DCMAKE_CXX_COMPILER=" + compiler, "-DCMAKE_CXX_FLAGS_RELEASE=" + flags]
  for command in configure, ["cmake", "--build", folder]:
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
      sys.exit(done.stdout[-5000:])


def vertices(file):
  with open(file, encoding="ascii") as opened:
    return [[float(x) for x in line.split()[1:4]] for line in opened if line.startswith("v ")]


def size(points):
  return sum((max(axis) - min(axis)) ** 2 for axis in zip(*points)) ** 0.5


def difference(file, reference):
  """The largest distance of a vertex from where it is in the reference, by the reference's size."""
  here, there = vertices(file), vertices(reference)
  if len(here) != len(there):
    sys.exit(f"{file} has {len(here)} vertices, {reference} has {len(there)}")
  return max(sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5
             for p, q in zip(here, there)) / size(there)


def run(programs, command, folder):
  tool, *arguments = command.split()
  os.makedirs(folder, exist_ok=True)
  done = subprocess.run([os.path.join(programs, "shape-" + tool), *arguments], cwd=folder,
                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
  if done.returncode != 0:
    sys.exit(f"{programs}: {command}: {done.stdout}")


def main():
  top = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "build/compilers"))
  programs = {name: os.path.join(top, name.replace(" ", ""), "bin") for name, _ in BUILDS}
  for name, settings in BUILDS:
    build(os.path.dirname(programs[name]), *settings)
  first, *others = programs
  print("| command | " + " | ".join(others) + " |\n|---|" + "---:|" * len(others))
  failed = False
  with tempfile.TemporaryDirectory() as work:
    for name in programs:
      folder = os.path.join(work, name)
      for body in lines(BODIES):
        run(programs[first], "body " + body, folder)  # the same bytes for all
      with open(os.path.join(folder, "handles.json"), "w", encoding="ascii") as file:
        json.dump(HANDLES, file)
    for number, command in enumerate(lines(COMMANDS)):
      written = {}
      for name in programs:
        folder = os.path.join(work, name, str(number))
        run(programs[name], command, folder)
        written[name] = sorted(os.listdir(folder))
      found = []
      for name in others:
        if not written[first] or written[name] != written[first]:
          sys.exit(f"{name}: {command}: wrote {written[name]}, {first} {written[first]}")
        found.append(max(difference(os.path.join(work, name, str(number), file),
                                    os.path.join(work, first, str(number), file))
                         for file in written[first]))
      failed = failed or max(found) > ALLOWED
      command = command.split(" --output")[0].replace("../", "")
      print(f"| `{command}` | " + " | ".join(f"{share:.1e}" for share in found) + " |", flush=True)
  return failed


if __name__ == "__main__":
  sys.exit(main())
