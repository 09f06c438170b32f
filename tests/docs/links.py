#!/usr/bin/python3
"""Whether the links of a site lead somewhere: those within it to a file, and to a place in that file
if they name one. Addresses of other sites are not asked.

    tests/docs/links.py FOLDER
"""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """The places of a page that can be linked to, and its links."""

    def __init__(self, file):
        super().__init__()
        self.places, self.links = set(), []
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (tag == "a" and name == "name"):
                self.places.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


def target_of(link, file, root):
    """The file and the place that a link of `file` leads to; None if that is another site."""
    parts = urllib.parse.urlsplit(link)
    if parts.scheme or parts.netloc:
        return None
    path = urllib.parse.unquote(parts.path)
    target = file if not path else root / path[1:] if path[0] == "/" else file.parent / path
    target = target.resolve()
    if target.is_dir():
        target /= "index.html"
    return target, urllib.parse.unquote(parts.fragment)


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = {file: Page(file) for file in sorted(root.rglob("*.html"))}
    if not pages:
        sys.exit(f"links.py: {root} has no pages")
    broken = number = 0
    for file, page in pages.items():
        for link in page.links:
            found = target_of(link, file, root)
            if found is None:
                continue
            number += 1
            target, place = found
            if not target.is_file() or root not in target.parents:
                reason = "there is no such file"
            elif place and target in pages and place not in pages[target].places:
                reason = "the page has no such place"
            else:
                continue
            print(f"{file.relative_to(root)}: {link}: {reason}", file=sys.stderr)
            broken += 1
    print(f"links.py: {len(pages)} pages, {number} links within them, {broken} broken")
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
