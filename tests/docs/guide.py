#!/usr/bin/env python3
"""Runs the commands of the guide as a reader would: guide.py BIN [page...].

BIN is the folder of the tools. Each page has a folder of its own, in which its `sh` blocks run one
after the other, while other pages run. Comments of a page say more about the block that follows
them:

    <!-- file: greet.json -->      the block is that file, which is there before the first command
    <!-- needs: ../markers.awk --> that file of the project is there too
    <!-- example: reason -->       the block is not run

Prints every block with its page and line, and ends with code 1 if one fails.
"""

import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

PROJECT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [*sorted((PROJECT / "docs/guide").glob("*.md")), PROJECT / "README.md"]
COMMENT = re.compile(r"<!-- (file|needs|example): (.*) -->")


def blocks_of(page):
    """(line, language, text, comments) of each fenced block; comments are pairs."""
    comments, fence, found = [], None, []
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if fence is None:
            comment = COMMENT.fullmatch(line)
            if comment:
                comments.append(comment.groups())
            elif line.startswith("```"):
                fence = (number, line[3:], [])
            elif line:
                comments = []
        elif line == "```":
            found.append((fence[0], fence[1], "\n".join(fence[2]) + "\n", comments))
            comments, fence = [], None
        else:
            fence[2].append(line)
    return found


def run_page(page, bin_folder):
    """Whether all blocks of a page ran."""
    environment = {**os.environ, "PATH": f"{bin_folder}:{os.environ['PATH']}"}
    blocks = blocks_of(page)
    with tempfile.TemporaryDirectory() as folder:
        for _, _, text, comments in blocks:
            for kind, value in comments:
                if kind == "file":
                    pathlib.Path(folder, value).write_text(text, encoding="utf-8")
                elif kind == "needs":
                    shutil.copy(page.parent / value, folder)
        for line, language, text, comments in blocks:
            if language != "sh":
                continue
            place = f"{page.relative_to(PROJECT)}:{line}"
            reason = dict(comments).get("example")
            if reason:
                print(f"{place}: not run: {reason}")
                continue
            begin = time.monotonic()
            result = subprocess.run(
                ["bash", "-euo", "pipefail", "-c", text],
                cwd=folder,
                env=environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
            )
            if result.returncode != 0:
                print(f"{place}: FAILED with code {result.returncode}:\n{text}\n{result.stdout}")
                return False
            print(f"{place}: ran, {time.monotonic() - begin:.1f} s", flush=True)
    return True


def main():
    bin_folder = pathlib.Path(sys.argv[1]).resolve()
    pages = [pathlib.Path(page).resolve() for page in sys.argv[2:]] or PAGES
    # Tools often use one core only: reading, writing, rendering.
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        ran = list(pool.map(lambda page: run_page(page, bin_folder), pages))
    failed = [page.name for page, well in zip(pages, ran) if not well]
    if failed:
        print(f"guide: blocks of {', '.join(failed)} cannot be followed", file=sys.stderr)
    sys.exit(1 if failed else 0)


main()
