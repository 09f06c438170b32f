#!/usr/bin/env python3
"""Whether the results depend on the compiler.

    tests/compilers.py [FOLDER]

Builds the tools with g++ and clang++, each without optimisation and with it, in FOLDER (build/compilers),
runs the same commands with each, and prints how far vertices are from those of the first build,
at most, as a share of the size of the first shape. Solves that end at a tolerance may differ by as much
as that allows. Exit code 1 if one differs by more than is stated beside its command. Takes a quarter
of an hour on two cores.
"""

import json
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILDS = [("g++ -O3", ["g++", "-O3 -DNDEBUG"]), ("g++ -O0", ["g++", "-O0"]),
          ("clang++ -O3", ["clang++", "-O3 -DNDEBUG"]), ("clang++ -O0", ["clang++", "-O0"])]

BODIES = [
    ["tube", "--triangles", "300", "--at", "0,45,90", "--output", "tube%d.obj"],
    ["tube", "--triangles", "300", "--at", "20", "--output", "other%d.obj"],
    ["sheet", "--triangles", "400", "--output", "sheet%d.obj"],
    ["bar", "--triangles", "400", "--output", "bar%d.obj"],
    ["miura", "--output", "miura%d.obj"],
    ["quadruped", "--triangles", "700", "--pose", "stand,stride,sit", "--output", "animal%d.obj"],
]

HANDLES = {"handles": [{"fixed": True, "select": {"vertices": [[1, 20]]}},
                       {"translation": [0, 0.2, 0], "select": {"vertices": [100, 101, 102]}}]}

# What is run, and the share of the size by which vertices may differ. Later ones may use the outputs
# of earlier ones.
TIGHT = ["--tolerance", "1e-12", "--max_iterations", "5000"]
COMMANDS = [
    ("geodesic, tube", 1e-5, ["interpolate", "tube0.obj", "tube2.obj", "--shapes", "5", *TIGHT,
                              "--output", "tube.path,OUT%d.obj"]),
    ("geodesic, sheet", 1e-5, ["interpolate", "sheet0.obj", "sheet1.obj", "--shapes", "5", *TIGHT,
                               "--output", "OUT%d.obj"]),
    ("geodesic, bar", 1e-5, ["interpolate", "bar0.obj", "bar1.obj", "--shapes", "5", *TIGHT,
                             "--output", "OUT%d.obj"]),
    ("geodesic, Miura fold", 1e-5, ["interpolate", "miura0.obj", "miura1.obj", "--shapes", "5",
                                    *TIGHT, "--output", "OUT%d.obj"]),
    ("geodesic, animal, default tolerance", 1e-2,
     ["interpolate", "animal0.obj", "animal1.obj", "--shapes", "5", "--output", "OUT%d.obj"]),
    ("the same, tight", 1e-5, ["interpolate", "animal0.obj", "animal1.obj", "--shapes", "5", *TIGHT,
                               "--output", "OUT%d.obj"]),
    ("the same, Ceres' L-BFGS", 1e-4, ["interpolate", "tube0.obj", "tube2.obj", "--shapes", "3",
                                       "--solver", "lbfgs", *TIGHT, "--output", "OUT%d.obj"]),
    ("the same, Ceres' trust region", 1e-5,
     ["interpolate", "tube0.obj", "tube2.obj", "--shapes", "3", "--solver", "trust_region", *TIGHT,
      "--output", "OUT%d.obj"]),
    ("spline, animal", 1e-4, ["interpolate", "animal0.obj", "animal1.obj", "animal2.obj", "--spline",
                              "natural", "--shapes", "3", *TIGHT, "--output", "OUT%d.obj"]),
    ("eight steps past the end, tube", 1e-5, ["extrapolate", "tube.path", "--steps", "8", "--output",
                                              "OUT%d.obj"]),
    ("transfer to another tube", 1e-5, ["transfer", "tube.path", "--target", "other0.obj",
                                        "--output", "OUT%d.obj"]),
    ("mean of three animals", 1e-3, ["average", "animal0.obj", "animal1.obj", "animal2.obj",
                                     "--output", "OUT0.obj"]),
    ("handles, tube", 1e-3, ["deform", "tube0.obj", "--handles", "handles.json", *TIGHT,
                             "--output", "OUT%d.obj"]),
]


def build(folder, compiler, flags):
  configure = ["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
               "-DCMAKE_UNITY_BUILD=ON", "-DSHAPESPACE_BUILD_TESTS=OFF",
               "-DCMAKE_CXX_COMPILER=" + compiler, "-DCMAKE_CXX_FLAGS_RELEASE=" + flags]
  for command in configure, ["cmake", "--build", folder]:
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
      sys.exit(done.stdout[-5000:])


def vertices(file):
  with open(file, encoding="ascii") as lines:
    return [[float(x) for x in line.split()[1:4]] for line in lines if line.startswith("v ")]


def size(points):
  return sum((max(axis) - min(axis)) ** 2 for axis in zip(*points)) ** 0.5


def difference(file, reference):
  """The largest distance of a vertex from where it is in the reference, by the reference's size."""
  here, there = vertices(file), vertices(reference)
  if len(here) != len(there):
    sys.exit(f"{file} has {len(here)} vertices, {reference} has {len(there)}")
  return max(sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5
             for p, q in zip(here, there)) / size(there)


def run(programs, folder):
  """Runs all commands in a folder; the names of the shapes that each wrote."""
  shapes = []
  for number, (name, _, command) in enumerate(COMMANDS):
    tool, *arguments = [part.replace("OUT", f"out{number}_") for part in command]
    done = subprocess.run([os.path.join(programs, "shape-" + tool), *arguments], cwd=folder,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0 or "not converged" in done.stdout:
      print(f"{programs}: {name}: {done.stdout}", file=sys.stderr)
    written = [file for file in os.listdir(folder) if re.match(f"out{number}_[0-9]+.obj", file)]
    if not written:
      sys.exit(f"{programs}: {name}: no shape was written: {done.stdout}")
    shapes.append(sorted(written))
  return shapes


def main():
  top = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "build/compilers"))
  for name, settings in BUILDS:
    build(os.path.join(top, name.replace(" ", "")), *settings)
  failed = False
  with tempfile.TemporaryDirectory() as work:
    programs = {name: os.path.join(top, name.replace(" ", ""), "bin") for name, _ in BUILDS}
    first = BUILDS[0][0]
    folders, shapes = {}, {}
    for name in programs:
      folders[name] = os.path.join(work, name.replace(" ", ""))
      os.makedirs(folders[name])
      for body in BODIES:  # all builds have the same bytes
        subprocess.run([os.path.join(programs[first], "shape-body"), *body], cwd=folders[name],
                       check=True, stdout=subprocess.DEVNULL)
      with open(os.path.join(folders[name], "handles.json"), "w", encoding="ascii") as file:
        json.dump(HANDLES, file)
      shapes[name] = run(programs[name], folders[name])
    others = [name for name in programs if name != first]
    print("| command | allowed | " + " | ".join(others) + " |\n|---|---:|" + "---:|" * len(others))
    for number, (name, allowed, _) in enumerate(COMMANDS):
      found = []
      for other in others:
        if shapes[other][number] != shapes[first][number]:
          sys.exit(f"{name}: {other} wrote other files")
        found.append(max(difference(os.path.join(folders[other], file),
                                    os.path.join(folders[first], file))
                         for file in shapes[first][number]))
      failed = failed or max(found) > allowed
      print(f"| {name} | {allowed:.0e} | " + " | ".join(f"{share:.1e}" for share in found) + " |")
  return failed


if __name__ == "__main__":
  sys.exit(main())
