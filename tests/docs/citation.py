#!/usr/bin/python3
"""Whether CITATION.cff has the keys, and values of the types, of the Citation File Format 1.2.0.

    tests/docs/citation.py [CITATION.cff]

The schema itself, https://github.com/citation-file-format/citation-file-format/blob/1.2.0/schema.json,
is in no package of Debian. What follows was written after it for the keys that our file has; any
other key is refused, so that whoever adds one adds its type here.
"""

import datetime
import pathlib
import re
import sys

import yaml


def text(value):
    return isinstance(value, str) and value != ""


def whole(value):
    return isinstance(value, int) and not isinstance(value, bool)


def text_or_number(value):
    return text(value) or whole(value) or isinstance(value, float)


def matches(pattern):
    return lambda value: isinstance(value, str) and re.fullmatch(pattern, value) is not None


def date(value):
    return isinstance(value, datetime.date) and not isinstance(value, datetime.datetime)


def people(value):
    def person(entry):
        keys = {"name"} if "name" in entry else {"family-names", "given-names"}
        return set(entry) <= keys and all(text(entry[key]) for key in entry)

    return isinstance(value, list) and bool(value) and all(map(person, value))


WORK = {
    "authors": people,
    "doi": matches(r"10\.\d{4,9}(\.\d+)?/[A-Za-z0-9:/_;\-.()\[\]\\]+"),
    "title": text,
}
ARTICLE = WORK | {
    "end": whole,
    "issue": text_or_number,
    "journal": text,
    "number": text_or_number,
    "start": whole,
    "type": lambda value: value == "article",
    "volume": whole,
    "year": whole,
}
SOFTWARE = WORK | {
    "cff-version": lambda value: value == "1.2.0",
    "date-released": date,
    "license": lambda value: value == "BSD-3-Clause",
    "message": text,
    "preferred-citation": lambda value: isinstance(value, dict),
    "type": lambda value: value == "software",
    "version": text_or_number,
}


def problems(work, keys, required):
    found = [f"{key} is missing" for key in sorted(required - set(work))]
    for key, value in work.items():
        if key not in keys:
            found.append(f"{key} is not a key that this test knows")
        elif not keys[key](value):
            found.append(f"{key} may not be {value!r}")
    return found


def main():
    file = sys.argv[1] if len(sys.argv) > 1 else "CITATION.cff"
    content = yaml.safe_load(pathlib.Path(file).read_text(encoding="utf-8"))
    found = problems(content, SOFTWARE, {"authors", "cff-version", "message", "title"})
    found += problems(content["preferred-citation"], ARTICLE, {"authors", "title", "type"})
    for problem in found:
        print(f"{file}: {problem}", file=sys.stderr)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
