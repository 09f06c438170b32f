#!/usr/bin/env python3
"""Finds comments that a formatter has shredded: lines within a sentence that end although the next word
would have fitted, by far.

  tests/docs/comments.py [file...]     all sources without arguments
"""
import re
import subprocess
import sys

COLUMNS = 100
SLACK = 30  # columns that a line may leave free besides those that the next word takes
COMMENT = re.compile(r"^(?P<code>.*?)(?P<mark>///?)<? ?(?P<text>[^/].*)$")
COMMAND = "       "  # the indent of what follows a line with a command of Doxygen


def comment_of(line):
    """The code before a line's comment, what begins it, and its text; None if it has none."""
    match = COMMENT.match(line)
    if not match or match["code"].count('"') % 2:
        return None
    return match["code"], match["mark"], match["text"]


def goes_on(line, following):
    """Whether the comment of the first line goes on in the second before it has to."""
    first, second = comment_of(line), comment_of(following)
    if not first or not second or second[0].strip() or first[1] != second[1]:
        return False
    if len(first[0]) != len(second[0]):
        return False
    text, continued = first[2], second[2]
    if text.startswith(" ") and not text.startswith(COMMAND):  # a formula
        return False
    if continued.startswith(" ") and not continued.startswith(COMMAND):
        return False
    word = continued.split()[0]
    in_sentence = re.search(r"[\w,)'`]$", text) and re.match(r"[a-z(`'\d]", word)
    return in_sentence and len(line.rstrip()) + 1 + len(word) + SLACK <= COLUMNS


def main():
    files = sys.argv[1:] or subprocess.run(
        ["git", "ls-files", "*.h", "*.cc"], check=True, capture_output=True,
        text=True).stdout.split()
    found = 0
    for name in files:
        with open(name, encoding="utf-8") as source:
            lines = source.read().split("\n")
        for number, (line, following) in enumerate(zip(lines, lines[1:]), 1):
            if goes_on(line, following):
                print(f"{name}:{number}: this comment goes on in the next line before it has to: "
                      f"{line.strip()}", file=sys.stderr)
                found += 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
