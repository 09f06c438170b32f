#!/usr/bin/python3
"""Collects the pages of the site:

    packaging/site_pages.py FOLDER

The documents lie in FOLDER as they lie in the repository. What they link to is beside them: pictures
and notebooks as they are, sources as pages that show them. Comments are left out.
"""

import pathlib
import re
import shutil
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent
COMMENT = re.compile(r"<!--.*?-->\n?", re.DOTALL)
LINK = re.compile(r"(\]\()([^)#\s]+)((?:#[^)\s]*)?\))")
AS_THEY_ARE = {".md", ".png", ".svg", ".ipynb", ".json"}
LANGUAGES = {".h": "cpp", ".cc": "cpp", ".sh": "sh"}


def documents():
    """The Markdown files of the repository, but the main page of the reference and templates."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"],
        cwd=PROJECT, check=True, capture_output=True, text=True,
    ).stdout
    hidden = ("docs/reference.md", ".github/", "debian/")
    return [pathlib.Path(line) for line in listed.splitlines() if not line.startswith(hidden)]


def show_source(file, target):
    """Writes the page that shows a source."""
    language = LANGUAGES.get(file.suffix, "text")
    text = (PROJECT / file).read_text(encoding="utf-8").rstrip()
    target.write_text(f"# {file}\n\n~~~~{language}\n{text}\n~~~~\n", encoding="utf-8")


def main():
    folder = pathlib.Path(sys.argv[1])
    if folder.exists():
        shutil.rmtree(folder)
    pages = documents()

    def follow(page, link):
        """The link as it is in the site; what it leads to is put there."""
        if "://" in link or link.startswith("mailto:"):
            return link
        file = ((PROJECT / page).parent / link).resolve().relative_to(PROJECT)
        if file in pages:
            return link
        if not (PROJECT / file).is_file():
            sys.exit(f"site_pages.py: {page} links to {link}, which is not there")
        target = folder / file
        target.parent.mkdir(parents=True, exist_ok=True)
        if file.suffix in AS_THEY_ARE:
            shutil.copyfile(PROJECT / file, target)
            return link
        show_source(file, target.with_name(target.name + ".md"))
        return link + ".md"

    for page in pages:
        text = (PROJECT / page).read_text(encoding="utf-8")
        parts = re.split(r"(^```.*?^```$)", text, flags=re.MULTILINE | re.DOTALL)
        for i in range(0, len(parts), 2):  # the others are code
            parts[i] = COMMENT.sub("", parts[i])
            parts[i] = LINK.sub(lambda m: m[1] + follow(page, m[2]) + m[3], parts[i])
        target = folder / page
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text("".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
